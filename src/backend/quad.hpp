#pragma once

#include <cmath>

#ifdef __FMA__
#include <immintrin.h>
#endif

namespace tread
{

/// Four numbers in one vector register, where the processor has one that wide. Host only: on a GPU the threads are the
/// lanes.
template<class Real>
struct Quad
{
    typedef Real Register __attribute__((vector_size(4 * sizeof(Real)))); // NOLINT(modernize-use-using)

    Register at;

    Real operator[](int i) const { return at[i]; }
    void set(int i, Real value) { at[i] = value; }

    friend Quad operator*(Real factor, const Quad& value) { return {factor * value.at}; }
};

#ifdef __FMA__
// Uses intrinsics, because the compiler turns a loop of std::fma over a register into scalar operations and shuffles.
inline __m256d multiply_add(double factor, __m256d value, __m256d sum)
{
    return _mm256_fmadd_pd(_mm256_set1_pd(factor), value, sum);
}
inline __m128 multiply_add(float factor, __m128 value, __m128 sum)
{
    return _mm_fmadd_ps(_mm_set1_ps(factor), value, sum);
}
#endif

/// Computes sum += factor * value with one rounding.
template<class Real>
inline void add_scaled(Real factor, const Quad<Real>& value, Quad<Real>& sum)
{
#ifdef __FMA__
    sum.at = multiply_add(factor, value.at, sum.at);
#else
    for (int i = 0; i < 4; ++i) { sum.set(i, std::fma(factor, value[i], sum[i])); }
#endif
}

} // namespace tread
