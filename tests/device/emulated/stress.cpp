#include "mpm/device/cuda/stress.cu"
