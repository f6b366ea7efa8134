// What one core of this machine can do at best, measured: the floors that kernels are held against.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace harness::kernels {

double processor_seconds();  // of this thread

// Reads an array, a multiple of read_granularity long, and does fused multiply-adds of vectors in
// registers. What is returned depends on all of it.
constexpr std::size_t read_granularity = 128;
double read_all(const Eigen::VectorXd& data);
double multiply_add(std::size_t times);
double flops_of_multiply_add(std::size_t times);

// A square root and a division an edge, independent of each other, in the first-level cache: what
// no pass that corrects every edge can go below. Seconds for one edge, the least of many.
using Lengths = std::array<double, 1024>;
Lengths some_lengths();
void sqrt_div(Lengths& lengths);
double sqrt_div_seconds();

// Bytes a second at which an array of that size is read over and over: of the cache that it fits
// into, or of memory. Measured at the first call for a size, to a factor of two.
double read_bandwidth(double bytes);
// Floating-point operations a second; a fused multiply-add is two. Measured at the first call.
double peak_flops();

}  // namespace harness::kernels
