#include "run/features.hpp"

#include <array>

#include <Eigen/Core>
#include <H5public.h>
#include <fmt/format.h>
#include <mpi.h>

#include "backend/backends.hpp"
#include "base/version.hpp"
#include "decomp/partition.hpp"

namespace tread::run
{
namespace
{

std::string mpi_library()
{
    std::array<char, MPI_MAX_LIBRARY_VERSION_STRING> text{};
    int                                              length = 0;
    MPI_Get_library_version(text.data(), &length);
    const std::string whole(text.data(), static_cast<std::size_t>(length));
    return whole.substr(0, whole.find_first_of(",\n"));
}

} // namespace

std::string features()
{
    std::string text = fmt::format("tread {}\ncommit: {}\n", version, commit());
    text += fmt::format("backends: cpu{}\nprocessor: {}\n", has_gpu ? ", cuda" : "", TREAD_PROCESSOR);
    text += fmt::format("partition: METIS{}\n", decomp::petsc_is_built_in() ? ", PETSc" : "");
    text += fmt::format("MPI: {}\nHDF5: {}.{}.{}\nEigen: {}.{}.{}", mpi_library(), H5_VERS_MAJOR, H5_VERS_MINOR,
                        H5_VERS_RELEASE, EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION);
    return text;
}

} // namespace tread::run
