#include "decomp/combine.hpp"

#include <algorithm>

namespace tread::decomp
{

void combine(const Communicator& communicator, double* values, int sums, int peaks)
{
    const int           count = sums + peaks;
    std::vector<double> all(static_cast<std::size_t>(count) * static_cast<std::size_t>(communicator.size()));
    const Waiting       wait(communicator.waits(), "all-gather of sums");
    check_mpi(MPI_Allgather(values, count, MPI_DOUBLE, all.data(), count, MPI_DOUBLE, communicator.native()),
              "all-gather");
    std::copy_n(all.begin(), count, values);
    for (std::size_t first = static_cast<std::size_t>(count); first < all.size();
         first += static_cast<std::size_t>(count))
    {
        for (int i = 0; i < count; ++i)
        {
            const double other = all[first + static_cast<std::size_t>(i)];
            values[i]          = i < sums ? values[i] + other : std::max(values[i], other);
        }
    }
}

} // namespace tread::decomp
