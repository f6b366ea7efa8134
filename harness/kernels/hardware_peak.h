// What one core of this machine can do at best, measured: the floors that kernels are held against.
#pragma once

#include <cstddef>

namespace harness {

double processor_seconds();  // of this thread

// Reads an array (aligned as Eigen's are, a multiple of read_granularity long), and does fused
// multiply-adds of vectors in registers. What is returned depends on all of it.
constexpr std::size_t read_granularity = 128;
double read_all(const double* data, std::size_t doubles);
double multiply_add(std::size_t times);
double flops_of_multiply_add(std::size_t times);

// Bytes a second at which an array of that size is read over and over: of the cache that it fits
// into, or of memory. Measured at the first call for a size, to a factor of two.
double read_bandwidth(double bytes);
// Floating-point operations a second; a fused multiply-add is two. Measured at the first call.
double peak_flops();

}  // namespace harness
