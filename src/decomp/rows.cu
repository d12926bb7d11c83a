#include "backend/launch.cuh"
#include "decomp/rows_impl.hpp"

namespace tread::decomp
{

void pack_rows(const Gpu& gpu, const Columns& columns, const std::int32_t* index, std::int64_t count, std::uint32_t* to)
{
    pack_all(gpu, columns, index, count, to);
}

void unpack_rows(const Gpu& gpu, const std::uint32_t* from, std::int64_t count, const Columns& columns,
                 const std::int32_t* index, std::int64_t first)
{
    unpack_all(gpu, from, count, columns, index, first);
}

} // namespace tread::decomp
