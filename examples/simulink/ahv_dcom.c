/* DCOM as a level-2 C MEX S-function over the generated C library.
 *
 *   continuous states   the model's, in the order of DcomState
 *   input port          the model's inputs, in the order of DcomInput
 *   output port 0       the states
 *   output port 1       quantities that are not states, in the order of DcomOutputs
 *   parameter 0         the initial state, a real vector
 *   parameter 1         the set of parameters: 0 that of the table, 1 section5.3
 *
 * Units are those of the library. This file was compiled and run against `stub/simstruc.h`, not in Simulink.
 */
#define S_FUNCTION_NAME ahv_dcom
#define S_FUNCTION_LEVEL 2

#include "simstruc.h"

#include <string.h>

#include "dcom.h"

/* Structs of the library hold doubles and nothing else. */
#define WIDTH(type) ((int_T)(sizeof(type) / sizeof(real_T)))

enum { PARAMETER_STATE, PARAMETER_SET, PARAMETERS };
enum { PORT_STATE, PORT_OUTPUTS, OUTPUT_PORTS };

/* Whether a parameter holds that many real numbers. */
static int_T is_real(const mxArray *value, size_t count)
{
    return mxIsDouble(value) && !mxIsComplex(value) && (mxGetNumberOfElements(value) == count);
}

#define MDL_CHECK_PARAMETERS
static void mdlCheckParameters(SimStruct *S)
{
    const mxArray *set = ssGetSFcnParam(S, PARAMETER_SET);
    if (!is_real(ssGetSFcnParam(S, PARAMETER_STATE), (size_t)WIDTH(DcomState))) {
        ssSetErrorStatus(S, "ahv_dcom: the first parameter must be the initial state, a real vector of 11 numbers");
        return;
    }
    if (!is_real(set, 1) || ((mxGetPr(set)[0] != 0.0) && (mxGetPr(set)[0] != 1.0))) {
        ssSetErrorStatus(S, "ahv_dcom: the second parameter must be 0, the set of the table, or 1, section5.3");
    }
}

static void mdlInitializeSizes(SimStruct *S)
{
    ssSetNumSFcnParams(S, PARAMETERS);
    if (ssGetNumSFcnParams(S) != ssGetSFcnParamsCount(S)) {
        /* Simulink reports the wrong number of parameters itself. */
        return;
    }
    mdlCheckParameters(S);
    if (ssGetErrorStatus(S) != NULL) {
        return;
    }
    ssSetSFcnParamTunable(S, PARAMETER_STATE, 0);
    ssSetSFcnParamTunable(S, PARAMETER_SET, 0);
    ssSetNumContStates(S, WIDTH(DcomState));
    ssSetNumDiscStates(S, 0);
    if (!ssSetNumInputPorts(S, 1) || !ssSetNumOutputPorts(S, OUTPUT_PORTS)) {
        return;
    }
    ssSetInputPortWidth(S, 0, WIDTH(DcomInput));
    /* Forces and moments at output port 1 depend on the inputs at once. */
    ssSetInputPortDirectFeedThrough(S, 0, 1);
    ssSetOutputPortWidth(S, PORT_STATE, WIDTH(DcomState));
    ssSetOutputPortWidth(S, PORT_OUTPUTS, WIDTH(DcomOutputs));
    ssSetNumSampleTimes(S, 1);
    /* What the parameters give is computed once and kept here: each block has its own. */
    ssSetNumRWork(S, WIDTH(DcomPrepared));
    ssSetNumIWork(S, 0);
    ssSetNumPWork(S, 0);
    ssSetNumModes(S, 0);
    ssSetNumNonsampledZCs(S, 0);
    ssSetOptions(S, SS_OPTION_EXCEPTION_FREE_CODE);
}

static void mdlInitializeSampleTimes(SimStruct *S)
{
    ssSetSampleTime(S, 0, CONTINUOUS_SAMPLE_TIME);
    ssSetOffsetTime(S, 0, 0.0);
}

#define MDL_START
static void mdlStart(SimStruct *S)
{
    DcomParameters parameters = dcom_nominal;
    DcomPrepared prepared;
    if (mxGetPr(ssGetSFcnParam(S, PARAMETER_SET))[0] == 1.0) {
        dcom_set_section5_3(&parameters);
    }
    dcom_prepare(&parameters, &prepared);
    (void)memcpy(ssGetRWork(S), &prepared, sizeof prepared);
}

#define MDL_INITIALIZE_CONDITIONS
static void mdlInitializeConditions(SimStruct *S)
{
    (void)memcpy(ssGetContStates(S), mxGetPr(ssGetSFcnParam(S, PARAMETER_STATE)), sizeof(DcomState));
}

/* State, inputs and prepared parameters of the block. */
static void read_block(SimStruct *S, DcomState *x, DcomInput *u, DcomPrepared *p)
{
    const InputRealPtrsType signals = ssGetInputPortRealSignalPtrs(S, 0);
    real_T inputs[sizeof(DcomInput) / sizeof(real_T)];
    int_T i;
    for (i = 0; i < WIDTH(DcomInput); i++) {
        inputs[i] = *signals[i];
    }
    (void)memcpy(u, inputs, sizeof *u);
    (void)memcpy(x, ssGetContStates(S), sizeof *x);
    (void)memcpy(p, ssGetRWork(S), sizeof *p);
}

static void mdlOutputs(SimStruct *S, int_T tid)
{
    DcomState x;
    DcomInput u;
    DcomPrepared p;
    DcomOutputs outputs;
    (void)tid;
    read_block(S, &x, &u, &p);
    dcom_outputs(&x, &u, &p, &outputs);
    (void)memcpy(ssGetOutputPortRealSignal(S, PORT_STATE), &x, sizeof x);
    (void)memcpy(ssGetOutputPortRealSignal(S, PORT_OUTPUTS), &outputs, sizeof outputs);
}

#define MDL_DERIVATIVES
static void mdlDerivatives(SimStruct *S)
{
    DcomState x;
    DcomInput u;
    DcomPrepared p;
    DcomState rate;
    read_block(S, &x, &u, &p);
    dcom_drift(&x, &u, &p, &rate);
    (void)memcpy(ssGetdX(S), &rate, sizeof rate);
}

static void mdlTerminate(SimStruct *S)
{
    (void)S;
}

#ifdef MATLAB_MEX_FILE
/* Such is the interface: an S-function includes its gateway. */
#include "simulink.c" /* NOLINT(bugprone-suspicious-include) */
#else
#include "cg_sfun.h"
#endif
