#include "backend/reduce.hpp"

#include <algorithm>

namespace tread
{
namespace
{

template<class Combine>
void fold_rows(const double* rows, std::int64_t count, int width, double* out, Combine combine)
{
    for (int w = 0; w < width; ++w) { out[w] = 0; }
    for (std::int64_t i = 0; i < count; ++i)
    {
        for (int w = 0; w < width; ++w) { out[w] = combine(out[w], rows[i * width + w]); }
    }
}

} // namespace

void sum_rows(const Cpu& cpu, const double* rows, std::int64_t count, int width, double* out)
{
    cpu.counters->launched("sum rows");
    fold_rows(rows, count, width, out, [](double a, double b) { return a + b; });
}

void sum_rows(const Cpu& cpu, const double* rows, std::int64_t count, int width, double* out, Array<Cpu, double>&)
{
    sum_rows(cpu, rows, count, width, out);
}

void largest_of_rows(const Cpu& cpu, const double* rows, std::int64_t count, int width, double* out)
{
    cpu.counters->launched("largest of rows");
    fold_rows(rows, count, width, out, [](double a, double b) { return std::max(a, b); });
}

} // namespace tread
