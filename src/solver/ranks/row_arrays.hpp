#pragma once

#include <cstdint>

#include "backend/array.hpp"
#include "decomp/rows.hpp"

namespace tread::solver
{

/// Takes rows of an array to their new places. `from`: of each present row, that before; rows without one before name
/// any, and get its values. `more`: number of further rows, which are not initialised.
template<class Exec, class T>
void take_rows(const Exec& exec, const Array<Exec, std::int32_t>& from, Array<Exec, T>& array, std::int64_t more = 0)
{
    Array<Exec, T> now(exec, array.name(), from.size() + more);
    decomp::pack_rows(exec, decomp::columns(array.data()), from.data(), from.size(),
                      reinterpret_cast<std::uint32_t*>(now.data()));
    array.swap(now);
}

} // namespace tread::solver
