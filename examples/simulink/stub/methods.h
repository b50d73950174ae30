/* The functions of an S-function, as the stub calls them. */
#ifndef AHV_STUB_METHODS_H
#define AHV_STUB_METHODS_H

#include "simstruc.h"

typedef struct Methods {
    void (*initialize_sizes)(SimStruct *S);
    void (*initialize_sample_times)(SimStruct *S);
    void (*start)(SimStruct *S);
    void (*initialize_conditions)(SimStruct *S);
    void (*outputs)(SimStruct *S, int_T tid);
    void (*derivatives)(SimStruct *S);
    void (*terminate)(SimStruct *S);
} Methods;

extern const Methods stub_methods;

#endif
