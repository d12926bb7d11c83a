#pragma once

#include <cstdint>

#include "backend/array.hpp"

namespace tread
{

/// out[w] = sum over i of rows[i * width + w], always in the same order on one backend; width <= 32.
void sum_rows(const Cpu&, const double* rows, std::int64_t count, int width, double* out);
void sum_rows(const Gpu&, const double* rows, std::int64_t count, int width, double* out);

/// The same for very many rows; `scratch` is kept between calls.
void sum_rows(const Cpu&, const double* rows, std::int64_t count, int width, double* out, Array<Cpu, double>& scratch);
void sum_rows(const Gpu&, const double* rows, std::int64_t count, int width, double* out, Array<Gpu, double>& scratch);

/// out[w] = largest over i of rows[i * width + w], at least 0.
void largest_of_rows(const Cpu&, const double* rows, std::int64_t count, int width, double* out);
void largest_of_rows(const Gpu&, const double* rows, std::int64_t count, int width, double* out);

} // namespace tread
