/* Drives the S-function through the stub, and compares it with calls of the library: both must agree to the bit. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "dcom.h"
#include "methods.h"
#include "simstruc.h"

#define COUNT(type) ((int_T)(sizeof(type) / sizeof(real_T)))
#define COUNT_OF_STATES (sizeof(DcomState) / sizeof(real_T))

static const DcomInput INPUT = {0.2820906, 0.2286478, 0.01};
static const DcomState START = {7702.0808, 85000.0, 0.001,      0.0262105, 0.002,  0.6275547,
                                0.3,       -0.0136979, -0.2, -0.0371914, 0.1};

static void expect(int holds, const char *what)
{
    if (!holds) {
        (void)fprintf(stderr, "the S-function fails: %s\n", what);
        exit(EXIT_FAILURE);
    }
}

int_T ssSetNumInputPorts(SimStruct *S, int_T count)
{
    S->input_ports = count;
    return count <= STUB_PORTS;
}

int_T ssSetNumOutputPorts(SimStruct *S, int_T count)
{
    S->output_ports = count;
    return count <= STUB_PORTS;
}

/* Whether two objects have the same bits. */
static int same(const void *a, const void *b, size_t size)
{
    return memcmp(a, b, size) == 0;
}

/* A block with its parameters and inputs, before any call. */
static void make_block(SimStruct *block, const mxArray *state, const mxArray *set, const real_T *inputs)
{
    int_T i;
    (void)memset(block, 0, sizeof *block);
    block->parameters[0] = state;
    block->parameters[1] = set;
    block->given_parameters = 2;
    for (i = 0; i < COUNT(DcomInput); i++) {
        block->inputs[0][i] = &inputs[i];
    }
}

static void refuses_wrong_parameters(const mxArray *state, const mxArray *set, const real_T *inputs)
{
    static SimStruct block;
    make_block(&block, state, set, inputs);
    stub_methods.initialize_sizes(&block);
    expect(block.error != NULL, "a wrong parameter is not refused");
}

static void flies(const mxArray *state, real_T chosen, const real_T *inputs)
{
    static SimStruct block;
    DcomParameters parameters = dcom_nominal;
    DcomPrepared p;
    DcomState rate;
    DcomState x = START;
    DcomOutputs outputs;
    const mxArray set = {&chosen, 1};
    int_T step;
    int_T i;

    make_block(&block, state, &set, inputs);
    stub_methods.initialize_sizes(&block);
    expect(block.error == NULL, "good parameters are refused");
    expect(block.cont_states == COUNT(DcomState) && block.input_width[0] == COUNT(DcomInput), "widths");
    expect(block.output_width[0] == COUNT(DcomState) && block.output_width[1] == COUNT(DcomOutputs), "widths");
    expect(block.r_work == COUNT(DcomPrepared) && block.r_work <= STUB_NUMBERS, "work");
    stub_methods.initialize_sample_times(&block);
    stub_methods.start(&block);
    stub_methods.initialize_conditions(&block);

    if (chosen == 1.0) {
        dcom_set_section5_3(&parameters);
    }
    dcom_prepare(&parameters, &p);
    /* Euler's steps, as a solver would take them. */
    for (step = 0; step < 100; step++) {
        real_T now[COUNT_OF_STATES];
        dcom_outputs(&x, &INPUT, &p, &outputs);
        dcom_drift(&x, &INPUT, &p, &rate);
        stub_methods.outputs(&block, 0);
        stub_methods.derivatives(&block);
        expect(same(block.outputs[0], &x, sizeof x), "states");
        expect(same(block.outputs[1], &outputs, sizeof outputs), "outputs");
        expect(same(block.rates, &rate, sizeof rate), "derivatives");
        for (i = 0; i < COUNT(DcomState); i++) {
            block.states[i] += 0.001 * block.rates[i];
            now[i] = block.states[i];
        }
        (void)memcpy(&x, now, sizeof x);
    }
    stub_methods.terminate(&block);
}

int main(void)
{
    real_T numbers[COUNT_OF_STATES];
    real_T inputs[sizeof(DcomInput) / sizeof(real_T)];
    real_T third = 2.0;
    const mxArray state = {numbers, COUNT_OF_STATES};
    const mxArray short_state = {numbers, COUNT_OF_STATES - 1U};
    const mxArray wrong_set = {&third, 1};

    (void)memcpy(numbers, &START, sizeof START);
    (void)memcpy(inputs, &INPUT, sizeof INPUT);
    refuses_wrong_parameters(&short_state, &wrong_set, inputs);
    refuses_wrong_parameters(&state, &wrong_set, inputs);
    flies(&state, 0.0, inputs);
    flies(&state, 1.0, inputs);
    (void)printf("the S-function has the bits of the library\n");
    return EXIT_SUCCESS;
}
