#include "io/directory_lock.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/errors.hpp"

namespace tread::io
{
namespace
{

/// Reads the beginning of an open file.
std::string text_of(int file)
{
    std::array<char, 512> text{};
    const auto            bytes = pread(file, text.data(), text.size(), 0);
    return {text.data(), static_cast<std::size_t>(std::max<ssize_t>(bytes, 0))};
}

std::string this_process()
{
    std::array<char, 256> host{};
    gethostname(host.data(), host.size() - 1);
    return fmt::format("process {} on {}", getpid(), host.data());
}

/// Whether a text has the form of this_process(), of any process on any machine.
bool names_process(const std::string& text)
{
    int  process = 0, read = 0;
    char host[256];
    return std::sscanf(text.c_str(), "process %d on %255s%n", &process, host, &read) == 2 &&
           static_cast<std::size_t>(read) == text.size();
}

/// Opens without blocking, whatever kind of file has that name.
int open_lock(const std::string& path, int flags)
{
    return open(path.c_str(), flags | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0644);
}

/// Whether a run may write into it: it is new, or the lock file of a run.
bool may_be_written(int file)
{
    struct stat facts   = {};
    const bool  regular = fstat(file, &facts) == 0 && S_ISREG(facts.st_mode);
    return regular && (facts.st_size == 0 || names_process(text_of(file)));
}

/// Writes the holder's name. A run that is killed during this still leaves a valid lock file.
void sign(int file)
{
    const std::string text    = this_process();
    const auto        written = pwrite(file, text.data(), text.size(), 0);
    const bool        said    = written > 0 && ftruncate(file, written) == 0;
    static_cast<void>(said); // failure is ignored: the text serves messages only
}

} // namespace

bool has_lock_of_run(const std::string& directory)
{
    const int file = open_lock(directory + "/" + lock_file, O_RDONLY);
    if (file < 0) { return false; }
    const bool marked = names_process(text_of(file));
    close(file);
    return marked;
}

class DirectoryLock::Held
{
public:
    explicit Held(const std::string& directory)
        : file_(open_lock(directory + "/" + lock_file, O_RDWR | O_CREAT))
    {
        const int reason = errno;
        if (file_ < 0 && reason != ELOOP)
        {
            throw EnvironmentError(fmt::format("{}/{}: {}", directory, lock_file, std::strerror(reason)));
        }
        if (file_ < 0 || !may_be_written(file_))
        {
            if (file_ >= 0) { close(file_); }
            throw InputError(fmt::format("{}/{}: is not the lock of a run, which would write into it: move it away, or "
                                         "--output names another place",
                                         directory, lock_file));
        }
        if (flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        {
            const std::string holder = text_of(file_);
            close(file_);
            throw EnvironmentError(fmt::format("{}: is in use by {}: one run at a time", directory,
                                               holder.empty() ? "another process" : holder));
        }
        sign(file_); // a file system without locks leaves runs unguarded, but does not stop them
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
