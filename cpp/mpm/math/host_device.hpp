#pragma once
// The seam to devices: functions marked MPM_HD compile for them too (nvcc), where a number is a
// double, and no vector type is known.
#if defined(__CUDACC__)
#define MPM_HD __host__ __device__
#else
#define MPM_HD
#endif
