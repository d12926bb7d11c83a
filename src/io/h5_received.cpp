#include <numeric>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "io/h5_parts.hpp"

// Checks files of unknown origin: HDF5 would follow their links, and read what they name, with the user's permissions.
namespace tread::io::h5
{
namespace
{

constexpr hsize_t largest_chunk = hsize_t{64}
                                  << 20; ///< bytes that HDF5 reads into memory to access any part of a chunk
constexpr int stop = 1;                  ///< ends an iteration

/// Description of a fault; empty if there is none.
using Finding = std::string;

const char* name_of(H5L_type_t type)
{
    switch (type)
    {
    case H5L_TYPE_SOFT:
        return "a soft link";
    case H5L_TYPE_EXTERNAL:
        return "a link to another file";
    default:
        return "a link of an unknown kind";
    }
}

herr_t check_link(hid_t, const char* name, const H5L_info_t* info, void* finding)
{
    if (info->type == H5L_TYPE_HARD) { return 0; }
    *static_cast<Finding*>(finding) = fmt::format("/{} is {}", name, name_of(info->type));
    return stop;
}

/// Fault in the storage of a data set.
Finding fault_of_storage(hid_t dataset)
{
    const Handle creation{H5Dget_create_plist(dataset), H5Pclose};
    const Handle type{H5Dget_type(dataset), H5Tclose};
    if (H5Pget_external_count(creation.id()) != 0) { return "keeps its values in another file"; }
    if (H5Pget_nfilters(creation.id()) != 0) { return "is stored through filters"; }
    switch (H5Pget_layout(creation.id()))
    {
    case H5D_COMPACT:
    case H5D_CONTIGUOUS:
        return {};
    case H5D_CHUNKED:
        break;
    case H5D_VIRTUAL:
        return "is made of other data sets (virtual)";
    default:
        return "is stored in an unknown way";
    }
    std::vector<hsize_t> chunk(H5S_MAX_RANK, 1);
    const int            rank = H5Pget_chunk(creation.id(), H5S_MAX_RANK, chunk.data());
    if (rank < 0) { return "is stored in unknown chunks"; }
    double bytes = static_cast<double>(H5Tget_size(type.id()));
    for (int i = 0; i < rank; ++i) { bytes *= static_cast<double>(chunk[static_cast<std::size_t>(i)]); }
    return bytes <= static_cast<double>(largest_chunk) ? "" : fmt::format("is stored in chunks of {:.3g} bytes", bytes);
}

herr_t check_object(hid_t file, const char* name, const H5O_info_t* info, void* finding)
{
    if (info->type != H5O_TYPE_DATASET) { return 0; }
    const Handle dataset{H5Dopen2(file, name, H5P_DEFAULT), H5Dclose};
    const auto   fault = dataset.id() < 0 ? Finding("cannot be opened") : fault_of_storage(dataset.id());
    if (fault.empty()) { return 0; }
    *static_cast<Finding*>(finding) = fmt::format("/{} {}", name, fault);
    return stop;
}

} // namespace

void require_self_contained(const File& file)
{
    Finding      finding;
    const herr_t links = H5Lvisit(file.id(), H5_INDEX_NAME, H5_ITER_NATIVE, check_link, &finding);
    if (links == 0)
    {
        check(H5Ovisit(file.id(), H5_INDEX_NAME, H5_ITER_NATIVE, check_object, &finding), file, "listing the file");
    }
    if (finding.empty()) { check(links, file, "listing the file"); }
    if (finding.empty()) { return; }
    throw EnvironmentError(
        fmt::format("{}: {}; accepted: a file that holds all of its data itself, plainly", file.path(), finding));
}

} // namespace tread::io::h5
