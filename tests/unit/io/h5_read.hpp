#pragma once

#include <string>
#include <vector>

#include <hdf5.h>

#include "io/h5.hpp"

// Reads files written by io, through plain HDF5 calls.
namespace tread::test
{

struct Dataset
{
    std::vector<hsize_t> shape;
    std::vector<double>  values; ///< converted
    std::string          units;
};

inline Dataset read_dataset(const std::string& path, const std::string& name)
{
    const io::h5::File   file = io::h5::File::open(path);
    const io::h5::Handle dataset{io::h5::checked(H5Dopen2(file.id(), name.c_str(), H5P_DEFAULT), path, name), H5Dclose};
    const io::h5::Handle space{H5Dget_space(dataset.id()), H5Sclose};

    Dataset result;
    result.shape.resize(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space.id())));
    H5Sget_simple_extent_dims(space.id(), result.shape.data(), nullptr);
    result.values.resize(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.id())));
    H5Dread(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, result.values.data());
    if (H5Aexists(dataset.id(), "units") > 0)
    {
        const io::h5::Handle attribute{H5Aopen(dataset.id(), "units", H5P_DEFAULT), H5Aclose};
        const io::h5::Handle type{H5Aget_type(attribute.id()), H5Tclose};
        char*                text = nullptr;
        H5Aread(attribute.id(), type.id(), &text);
        result.units = text;
        H5free_memory(text);
    }
    return result;
}

inline bool has_object(const std::string& path, const std::string& name)
{
    const io::h5::File file = io::h5::File::open(path);
    return H5Lexists(file.id(), name.c_str(), H5P_DEFAULT) > 0;
}

} // namespace tread::test
