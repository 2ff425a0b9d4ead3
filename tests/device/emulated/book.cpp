// The code for a device, compiled for the processor.
#include "mpm/device/cuda/interface.cu"
#include "mpm/device/cuda/lists.cu"
#include "mpm/device/cuda/run.cu"
