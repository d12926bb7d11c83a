#pragma once

#include <cstdlib>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "backend/backends.hpp"

// One test body for every backend: TYPED_TEST_SUITE(Name, tread::test::Backends, tread::test::BackendNames).
// TREAD_TEST_BACKEND=cpu|cuda selects one of them; cuda is skipped if there is no device.
namespace tread::test
{

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
        device = std::make_unique<Device>(0, counters);
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
