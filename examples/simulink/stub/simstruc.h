/* A stub of `simstruc.h`: NOT MathWorks' header, and no copy of it.
 *
 * It declares what `ahv_dcom.c` uses of the S-function interface, by the public names, over a struct of its own, so
 * that the file compiles and runs in the tests without MATLAB. It shows that the S-function computes what the library
 * computes; it does not show that Simulink accepts it: nothing was run there.
 */
#ifndef AHV_STUB_SIMSTRUC_H
#define AHV_STUB_SIMSTRUC_H

#include <stddef.h>

typedef double real_T;
typedef int int_T;
typedef const real_T *const *InputRealPtrsType;

#define STUB_PORTS 4
#define STUB_PARAMETERS 4
#define STUB_NUMBERS 512

#define CONTINUOUS_SAMPLE_TIME 0.0
#define SS_OPTION_EXCEPTION_FREE_CODE 1U

/* A real matrix, of which only the number of elements is known. */
typedef struct mxArray {
    real_T *numbers;
    size_t count;
} mxArray;

#define mxIsDouble(a) ((a)->numbers != NULL)
#define mxIsComplex(a) ((void)(a), 0)
#define mxGetNumberOfElements(a) ((a)->count)
#define mxGetPr(a) ((a)->numbers)

/* A block: what it asked for, and what it computes with. */
typedef struct SimStruct {
    const char *error;
    const mxArray *parameters[STUB_PARAMETERS];
    int_T given_parameters;
    int_T asked_parameters;
    int_T cont_states;
    int_T disc_states;
    int_T input_ports;
    int_T output_ports;
    int_T input_width[STUB_PORTS];
    int_T feed_through[STUB_PORTS];
    int_T output_width[STUB_PORTS];
    int_T sample_times;
    int_T r_work;
    int_T i_work;
    int_T p_work;
    int_T modes;
    int_T zero_crossings;
    unsigned options;
    real_T sample_time;
    real_T offset_time;
    real_T states[STUB_NUMBERS];
    real_T rates[STUB_NUMBERS];
    real_T work[STUB_NUMBERS];
    const real_T *inputs[STUB_PORTS][STUB_NUMBERS];
    real_T outputs[STUB_PORTS][STUB_NUMBERS];
} SimStruct;

/* Whether there can be that many ports. */
int_T ssSetNumInputPorts(SimStruct *S, int_T count);
int_T ssSetNumOutputPorts(SimStruct *S, int_T count);

#define ssSetErrorStatus(S, text) ((S)->error = (text))
#define ssGetErrorStatus(S) ((S)->error)
#define ssSetNumSFcnParams(S, n) ((S)->asked_parameters = (n))
#define ssGetNumSFcnParams(S) ((S)->asked_parameters)
#define ssGetSFcnParamsCount(S) ((S)->given_parameters)
#define ssGetSFcnParam(S, i) ((S)->parameters[i])
#define ssSetSFcnParamTunable(S, i, yes) ((void)(S), (void)(i), (void)(yes))
#define ssSetNumContStates(S, n) ((S)->cont_states = (n))
#define ssSetNumDiscStates(S, n) ((S)->disc_states = (n))
#define ssSetInputPortWidth(S, port, n) ((S)->input_width[port] = (n))
#define ssSetInputPortDirectFeedThrough(S, port, yes) ((S)->feed_through[port] = (yes))
#define ssSetOutputPortWidth(S, port, n) ((S)->output_width[port] = (n))
#define ssSetNumSampleTimes(S, n) ((S)->sample_times = (n))
#define ssSetNumRWork(S, n) ((S)->r_work = (n))
#define ssSetNumIWork(S, n) ((S)->i_work = (n))
#define ssSetNumPWork(S, n) ((S)->p_work = (n))
#define ssSetNumModes(S, n) ((S)->modes = (n))
#define ssSetNumNonsampledZCs(S, n) ((S)->zero_crossings = (n))
#define ssSetOptions(S, flags) ((S)->options = (flags))
#define ssSetSampleTime(S, i, t) ((void)(i), (S)->sample_time = (t))
#define ssSetOffsetTime(S, i, t) ((void)(i), (S)->offset_time = (t))
#define ssGetContStates(S) ((S)->states)
#define ssGetdX(S) ((S)->rates)
#define ssGetRWork(S) ((S)->work)
#define ssGetInputPortRealSignalPtrs(S, port) ((S)->inputs[port])
#define ssGetOutputPortRealSignal(S, port) ((S)->outputs[port])

#endif
