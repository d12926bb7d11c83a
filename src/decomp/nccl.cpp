#include "decomp/nccl.hpp"

#include <cstdlib>
#include <cstring>

#include <dlfcn.h>
#include <fmt/format.h>

namespace tread::decomp
{
namespace
{

// Constants of nccl.h, version 2. This file declares what it uses of that header, so that building tread does not need
// it.
constexpr int success    = 0;
constexpr int type_uint8 = 1;
constexpr int type_int32 = 2;
constexpr int maximum    = 2;

} // namespace

/// Handle of the library. It stays open until the process ends: its threads may outlive the last communicator.
struct NcclLibrary
{
    struct UniqueId
    {
        char bytes[128];
    };

    using GetUniqueId = int (*)(UniqueId*);
    using InitRank    = int (*)(void** comm, int ranks, UniqueId id, int rank);
    using Destroy     = int (*)(void* comm);
    using Group       = int (*)();
    using Send        = int (*)(const void*, std::size_t count, int type, int peer, void* comm, CUstream_st*);
    using Receive     = int (*)(void*, std::size_t count, int type, int peer, void* comm, CUstream_st*);
    using AllReduce = int (*)(const void*, void*, std::size_t count, int type, int operation, void* comm, CUstream_st*);
    using ErrorString = const char* (*)(int);

    void*       handle        = nullptr;
    GetUniqueId get_unique_id = nullptr;
    InitRank    init_rank     = nullptr;
    Destroy     destroy       = nullptr;
    Group       group_start   = nullptr;
    Group       group_end     = nullptr;
    Send        send          = nullptr;
    Receive     receive       = nullptr;
    AllReduce   all_reduce    = nullptr;
    ErrorString error_string  = nullptr;

    template<class Function>
    bool find(Function& function, const char* name)
    {
        function = reinterpret_cast<Function>(dlsym(handle, name));
        return function != nullptr;
    }

    bool open()
    {
        handle = dlopen("libnccl.so.2", RTLD_NOW | RTLD_LOCAL);
        return handle != nullptr && find(get_unique_id, "ncclGetUniqueId") && find(init_rank, "ncclCommInitRank") &&
               find(destroy, "ncclCommDestroy") && find(group_start, "ncclGroupStart") &&
               find(group_end, "ncclGroupEnd") && find(send, "ncclSend") && find(receive, "ncclRecv") &&
               find(all_reduce, "ncclAllReduce") && find(error_string, "ncclGetErrorString");
    }

    void check(int result, const char* what) const
    {
        if (result == success) { return; }
        throw EnvironmentError(fmt::format("NCCL: {} in {}", error_string(result), what));
    }
};

Nccl::Nccl(const Communicator& communicator)
    : library_(std::make_unique<NcclLibrary>())
{
    const bool opened = library_->open();
    if (communicator.maximum(opened ? 0 : 1) > 0 || !opened)
    {
        throw EnvironmentError("NCCL: not every rank finds libnccl.so.2");
    }
    // Sends and receives do not use NVLink multicast, which occupies resources of the whole machine.
    setenv("NCCL_NVLS_ENABLE", "0", 1);
    NcclLibrary::UniqueId id{};
    if (communicator.rank() == 0) { library_->check(library_->get_unique_id(&id), "unique id"); }
    const std::string text = communicator.broadcast(std::string(id.bytes, sizeof(id.bytes)));
    std::memcpy(id.bytes, text.data(), sizeof(id.bytes));
    const int          result = library_->init_rank(&native_, communicator.size(), id, communicator.rank());
    const std::int64_t worst  = communicator.maximum(result);
    if (worst == success) { return; }
    if (result == success) { library_->destroy(native_); }
    throw EnvironmentError(fmt::format("NCCL does not start: {}", library_->error_string(static_cast<int>(worst))));
}

Nccl::~Nccl() { library_->destroy(native_); }

void Nccl::exchange(const Gpu& gpu, const MessageRanges& out, const std::byte* from, const MessageRanges& in,
                    std::byte* to)
{
    const NcclLibrary& nccl = *library_;
    nccl.check(nccl.group_start(), "group start");
    for (const MessageRange& range : in)
    {
        nccl.check(nccl.receive(to + range.first, static_cast<std::size_t>(range.bytes), type_uint8, range.rank,
                                native_, gpu.stream),
                   "receive");
    }
    for (const MessageRange& range : out)
    {
        nccl.check(nccl.send(from + range.first, static_cast<std::size_t>(range.bytes), type_uint8, range.rank, native_,
                             gpu.stream),
                   "send");
    }
    nccl.check(nccl.group_end(), "group end");
}

void Nccl::largest(const Gpu& gpu, std::int32_t* number)
{
    library_->check(library_->all_reduce(number, number, 1, type_int32, maximum, native_, gpu.stream), "all-reduce");
}

} // namespace tread::decomp
