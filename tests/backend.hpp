#pragma once

#include <cstdlib>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "backend/backends.hpp"

// One test body for every backend: TYPED_TEST_SUITE(Name, tread::test::Backends, tread::test::BackendNames).
// TREAD_TEST_BACKEND=cpu|cuda selects one of them; cuda is skipped if there is no device. TREAD_TEST_DEVICE is the
// number of the device, 0 if not set; mpi_session.hpp gives the ranks of a machine one each.
namespace tread::test
{

/// Device of this process, where there is one.
inline int device_number()
{
    const char* wanted = std::getenv("TREAD_TEST_DEVICE");
    return wanted == nullptr ? 0 : std::stoi(wanted) % device_count();
}

template<class Exec>
class BackendTest;

template<>
class BackendTest<Cpu> : public ::testing::Test
{
protected:
    void SetUp() override
    {
        const char* wanted = std::getenv("TREAD_TEST_BACKEND");
        if (wanted != nullptr && std::string(wanted) != "cpu") { GTEST_SKIP() << "TREAD_TEST_BACKEND=" << wanted; }
    }

    Cpu exec() { return {&counters}; }

    Counters counters;
};

template<>
class BackendTest<Gpu> : public ::testing::Test
{
protected:
    void SetUp() override
    {
        const char* wanted = std::getenv("TREAD_TEST_BACKEND");
        if (wanted != nullptr && std::string(wanted) != "cuda") { GTEST_SKIP() << "TREAD_TEST_BACKEND=" << wanted; }
        if (device_count() == 0) { GTEST_SKIP() << "no CUDA device"; }
        device = std::make_unique<Device>(device_number(), counters);
    }

    Gpu exec() { return device->gpu(); }

    Counters                counters;
    std::unique_ptr<Device> device;
};

using Backends = BackendList<::testing::Types>;

struct BackendNames
{
    template<class Exec>
    static std::string GetName(int)
    {
        return is_gpu<Exec> ? "cuda" : "cpu";
    }
};

} // namespace tread::test
