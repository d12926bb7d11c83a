#pragma once

#include <cstdlib>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "base/communicator.hpp"

#if defined(__SANITIZE_ADDRESS__)
/// Open MPI unloads its plugins at the end; leaks in them could then neither be attributed nor suppressed
/// (ci/lsan.supp). So nothing is unloaded in sanitizer builds.
extern "C" __attribute__((weak, visibility("default"))) int dlclose(void*) { return 0; }
#endif

// MPI for test programs: one session around all tests of a program that includes this header.
namespace tread::test
{

class MpiEnvironment : public ::testing::Environment
{
public:
    void SetUp() override
    {
        session_ = std::make_unique<MpiSession>();
        setenv("TREAD_TEST_DEVICE", std::to_string(world().local_rank()).c_str(), 0);
    }
    void TearDown() override { session_.reset(); }

    const Communicator& world() const { return session_->world(); }

private:
    std::unique_ptr<MpiSession> session_;
};

inline const MpiEnvironment* const mpi_environment =
    static_cast<MpiEnvironment*>(::testing::AddGlobalTestEnvironment(new MpiEnvironment));

inline const Communicator& world() { return mpi_environment->world(); }

} // namespace tread::test
