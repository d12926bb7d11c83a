#pragma once

#include <cstdint>

#include "backend/array.hpp"

namespace tread
{

/// Computes out[w] = sum over i of rows[i * width + w], in a fixed order on one backend; width <= 32.
void sum_rows(const Cpu&, const double* rows, std::int64_t count, int width, double* out);
void sum_rows(const Gpu&, const double* rows, std::int64_t count, int width, double* out);

/// Computes this sum with memory that is kept between calls, where there are very many rows.
void sum_rows(const Cpu&, const double* rows, std::int64_t count, int width, double* out, Array<Cpu, double>& scratch);
void sum_rows(const Gpu&, const double* rows, std::int64_t count, int width, double* out, Array<Gpu, double>& scratch);

/// Computes out[w] = maximum over i of rows[i * width + w], at least 0.
void largest_of_rows(const Cpu&, const double* rows, std::int64_t count, int width, double* out);
void largest_of_rows(const Gpu&, const double* rows, std::int64_t count, int width, double* out);

} // namespace tread
