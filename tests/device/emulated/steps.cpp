#include "mpm/device/cuda/make_step.cu"
