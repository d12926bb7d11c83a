#include "solver/ranks/rest_of_ranks.hpp"

#include <algorithm>
#include <utility>

#include "decomp/messages.hpp"

namespace tread::solver
{
namespace
{

template<class T>
void gather(const Communicator& communicator, std::vector<T>& values)
{
    std::vector<T> all;
    for (const auto& of_rank : decomp::gather_values(communicator, values))
    {
        all.insert(all.end(), of_rank.begin(), of_rank.end());
    }
    values = std::move(all);
}

/// Joins the rows of a page. Takes them in any order, and leaves keys ascending.
void join_pages(std::vector<AwakePage>& pages)
{
    std::sort(pages.begin(), pages.end(), [](const AwakePage& a, const AwakePage& b) { return a.key < b.key; });
    std::size_t joined = 0;
    for (const AwakePage& page : pages)
    {
        if (joined == 0 || pages[joined - 1].key != page.key)
        {
            pages[joined++] = page;
            continue;
        }
        AwakePage& known = pages[joined - 1];
        known.speed      = std::max(known.speed, page.speed);
        known.quiet      = std::min(known.quiet, page.quiet);
    }
    pages.resize(joined);
}

} // namespace

void gather_rest(const Communicator* communicator, RestState& state)
{
    if (communicator == nullptr) { return; }
    gather(*communicator, state.awake);
    join_pages(state.awake);
    gather(*communicator, state.pressed);
    std::sort(state.pressed.begin(), state.pressed.end());
    state.pressed.erase(std::unique(state.pressed.begin(), state.pressed.end()), state.pressed.end());
    gather(*communicator, state.bodies);
}

std::vector<BodyReach> bodies_of_ranks(const Communicator* communicator, std::vector<BodyReach> bodies)
{
    if (communicator != nullptr) { gather(*communicator, bodies); }
    return bodies;
}

} // namespace tread::solver
