#pragma once

#include <utility>
#include <vector>

#include "backend/array.hpp"
#include "io/accept.hpp"
#include "solver/ranks/body_blocks.hpp"
#include "solver/ranks/body_numbers.hpp"
#include "solver/state_file.hpp"

namespace tread::solver
{

/// Saves or loads arrays that have a row for each body, as one array of all bodies of the scene.
template<class Exec>
struct RowTransfer
{
    template<class T, class Bound>
    void operator()(const char* name, Array<Exec, T>& array, const Bound& accepted)
    {
        std::vector<T> values = array.to_host();
        if (!file.loads()) { values = order.rows(std::move(values)); }
        file.parts(name, values, accept::all(accept::rows(numbers.bodies()), accepted));
        if (file.loads()) { array.assign(numbers.of_rows(values)); }
    }

    StateFile&         file;
    const BodyNumbers& numbers;
    BodyBlocks         order; ///< of the file
};

} // namespace tread::solver
