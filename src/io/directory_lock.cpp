#include "io/directory_lock.hpp"

#include <array>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include "base/errors.hpp"

namespace tread::io
{
namespace
{

std::string holder_of(int file)
{
    std::array<char, 512> text{};
    const auto            bytes = pread(file, text.data(), text.size(), 0);
    return bytes > 0 ? std::string(text.data(), static_cast<std::size_t>(bytes)) : "another process";
}

std::string this_process()
{
    std::array<char, 256> host{};
    gethostname(host.data(), host.size() - 1);
    return fmt::format("process {} on {}", getpid(), host.data());
}

} // namespace

class DirectoryLock::Held
{
public:
    explicit Held(const std::string& directory)
        : file_(open((directory + "/" + lock_file).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644))
    {
        if (file_ < 0) { throw EnvironmentError(fmt::format("{}/{}: {}", directory, lock_file, std::strerror(errno))); }
        if (flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        {
            const std::string holder = holder_of(file_);
            close(file_);
            throw EnvironmentError(fmt::format("{}: is in use by {}: one run at a time", directory, holder));
        }
        // A file system without locks leaves runs unguarded, but lets them run.
        const std::string self = this_process();
        const bool        said = ftruncate(file_, 0) == 0 && pwrite(file_, self.data(), self.size(), 0) > 0;
        static_cast<void>(said); // only for the message above
    }
    ~Held() { close(file_); }
    Held(const Held&)            = delete;
    Held& operator=(const Held&) = delete;

private:
    int file_;
};

DirectoryLock::DirectoryLock(const Communicator& communicator, const std::string& directory)
{
    on_root(communicator, [&] { held_ = std::make_shared<const Held>(directory); });
}

} // namespace tread::io
