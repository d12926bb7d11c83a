#include "base/wait_board.hpp"

#include <random>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

namespace tread
{

WaitBoard::WaitBoard(const Communicator& world)
    : world_(world)
{
    const std::string              host  = host_name();
    const std::vector<std::string> hosts = world.gather(host);
    for (int rank = 0; rank < world.size(); ++rank)
    {
        if (rank == world.rank()) { own_ = ranks_.size(); }
        if (hosts[static_cast<std::size_t>(rank)] == host) { ranks_.push_back(rank); }
    }
    const bool  leads = own_ == 0;
    std::string name;
    if (leads) { name = fmt::format("/tread-{}-{:08x}", ::getpid(), std::random_device{}()); }
    bool                           opened = !leads || open(name, O_CREAT | O_EXCL);
    const std::vector<std::string> names  = world.gather(name);
    if (!leads) { opened = open(names[static_cast<std::size_t>(ranks_.front())], 0); }
    const bool all_opened = world.sum(opened ? 0 : 1) == 0;
    if (leads) { ::shm_unlink(name.c_str()); }
    if (!all_opened && counts_ != nullptr)
    {
        ::munmap(counts_, bytes());
        counts_ = nullptr;
    }
    if (counts_ != nullptr) { world.waits().count_collectives(&counts_[own_]); }
}

WaitBoard::~WaitBoard()
{
    if (counts_ == nullptr) { return; }
    world_.waits().count_collectives(nullptr);
    ::munmap(counts_, bytes());
}

/// Maps the memory of that name, which a flag O_CREAT makes; new memory is zero. False if that fails.
bool WaitBoard::open(const std::string& name, int flags)
{
    const int file = ::shm_open(name.c_str(), O_RDWR | flags, 0600);
    if (file < 0) { return false; }
    const bool sized = (flags & O_CREAT) == 0 || ::ftruncate(file, static_cast<off_t>(bytes())) == 0;
    void*      at    = sized ? ::mmap(nullptr, bytes(), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0) : MAP_FAILED;
    ::close(file);
    if (at == MAP_FAILED) { return false; }
    counts_ = static_cast<Count*>(at);
    return true;
}

std::vector<int> WaitBoard::behind() const
{
    std::vector<int> ranks;
    for (std::size_t k = 0; k < ranks_.size() && counts_ != nullptr; ++k)
    {
        if (counts_[k] < counts_[own_]) { ranks.push_back(ranks_[k]); }
    }
    return ranks;
}

} // namespace tread
