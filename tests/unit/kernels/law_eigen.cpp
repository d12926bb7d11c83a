#include <limits>

#include "law_support.hpp"

// Eigen-decomposition: reconstruction and orthogonality in units of the rounding of Real.
namespace
{

using namespace tread;
using namespace tread::mpm;
using namespace tread::test;

template<class Real>
class SymmetricEigenTest : public ::testing::Test
{
};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(SymmetricEigenTest, Reals);

/// Largest errors seen, in epsilons of Real.
struct Worst
{
    double reconstruction = 0; ///< |sum l v v^T - s| / |s|
    double orthogonality  = 0; ///< |V^T V - 1|
};

template<class Real>
void decompose(const Sym3<Real>& tensor, Worst& worst)
{
    const double       epsilon = std::numeric_limits<Real>::epsilon();
    const auto         eigen   = symmetric_eigen(tensor);
    const Mat3<double> axes    = eigen.axes.template cast<double>();
    const Mat3<double> given   = full_matrix(Sym3<double>(tensor.template cast<double>()));
    const Mat3<double> rebuilt = axes * eigen.values.template cast<double>().asDiagonal() * axes.transpose();
    ASSERT_GE(eigen.values[0], eigen.values[1]);
    ASSERT_GE(eigen.values[1], eigen.values[2]);
    if (given.norm() > 0)
    {
        worst.reconstruction = std::max(worst.reconstruction, (rebuilt - given).norm() / given.norm() / epsilon);
    }
    worst.orthogonality =
        std::max(worst.orthogonality, (axes.transpose() * axes - Mat3<double>::Identity()).norm() / epsilon);
}

/// A tensor of any magnitude from 1 mPa to 100 MPa whose eigenvalues differ by the shares `first` and `second`.
template<class Real>
Sym3<Real> tensor_with(Random& random, const Vec3<double>& values)
{
    const Mat3<double> q    = random_rotation(random);
    const double       size = std::pow(10.0, random.uniform(-3, 8));
    return symmetric(size * q * values.asDiagonal() * q.transpose()).template cast<Real>();
}

double tiny(Random& random) { return std::pow(10.0, random.uniform(-17, -1)); }

void report(const Worst& worst)
{
    // Ten: three products of length three, an eigenvector from products of length two, and a root, each rounded.
    expect_below("reconstruction, epsilons", worst.reconstruction, 10, "some ten roundings of order |s|");
    expect_below("orthogonality, epsilons", worst.orthogonality, 10, "some ten roundings of order 1");
}

TYPED_TEST(SymmetricEigenTest, RandomTensors)
{
    Random random(1);
    Worst  worst;
    for (int n = 0; n < 1000000; ++n)
    {
        decompose(tensor_with<TypeParam>(random, {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}),
                  worst);
    }
    report(worst);
}

TYPED_TEST(SymmetricEigenTest, TwoOrThreeNearlyEqualValues)
{
    Random random(2);
    Worst  worst;
    for (int n = 0; n < 300000; ++n)
    {
        const double value = random.uniform(-1, 1);
        decompose(tensor_with<TypeParam>(random, {value, value * (1 + tiny(random)), random.uniform(-1, 1)}), worst);
        decompose(tensor_with<TypeParam>(random, {value, value + tiny(random), value + tiny(random)}), worst);
    }
    report(worst);
}

TYPED_TEST(SymmetricEigenTest, EveryTensorOfSmallIntegers)
{
    Worst worst;
    for (int code = 0; code < 729; ++code)
    {
        Sym3<TypeParam> tensor;
        for (int c = 0, rest = code; c < 6; ++c, rest /= 3) { tensor[c] = static_cast<TypeParam>(rest % 3 - 1); }
        decompose(tensor, worst);
    }
    report(worst);
}

TYPED_TEST(SymmetricEigenTest, NotANumberStaysOne)
{
    for (int c = 0; c < 6; ++c)
    {
        Sym3<TypeParam> tensor = Sym3<TypeParam>::Ones();
        tensor[c]              = std::numeric_limits<TypeParam>::quiet_NaN();
        EXPECT_TRUE(std::isnan(symmetric_eigen(tensor).values.sum()));
    }
}

} // namespace
