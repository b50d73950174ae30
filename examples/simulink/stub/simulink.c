/* A stub: NOT MathWorks' file. An S-function includes it at its end; it shows the functions to `drive.c`. */
#include "methods.h"

const Methods stub_methods = {
    mdlInitializeSizes, mdlInitializeSampleTimes, mdlStart,    mdlInitializeConditions,
    mdlOutputs,         mdlDerivatives,           mdlTerminate,
};
