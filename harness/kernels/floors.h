// What one core of this machine can do at best, measured: the floors that kernels are held against.
#pragma once

namespace harness::kernels {

double processor_seconds();  // of this thread

// Seconds for a square root and a division, the least of many: what no pass that corrects every
// edge can go below.
double sqrt_div_seconds();
// Bytes a second at which an array of that size is read over and over: of the cache that it fits
// into, or of memory. Measured at the first call for a size, to a factor of two.
double read_bandwidth(double bytes);
// Floating-point operations a second; a fused multiply-add is two. Measured at the first call.
double peak_flops();

void register_floors();

}  // namespace harness::kernels
