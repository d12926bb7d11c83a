#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <unistd.h>

// Files for readers that take a path instead of bytes.
namespace tread::fuzz
{

/// A file of this process, in memory if possible; removed when the process ends.
class ScratchFile
{
public:
    explicit ScratchFile(const std::string& suffix)
        : path_(folder() + "/tread-fuzz-" + std::to_string(getpid()) + suffix)
    {
    }
    ~ScratchFile() { std::remove(path_.c_str()); }
    ScratchFile(const ScratchFile&)            = delete;
    ScratchFile& operator=(const ScratchFile&) = delete;

    const std::string& path() const { return path_; }

    void write(const void* bytes, std::size_t size) const
    {
        std::FILE* file = std::fopen(path_.c_str(), "wb");
        if (file == nullptr || std::fwrite(bytes, 1, size, file) != size || std::fclose(file) != 0) { std::abort(); }
    }

private:
    static std::string folder()
    {
        return std::filesystem::is_directory("/dev/shm") ? "/dev/shm" : std::filesystem::temp_directory_path().string();
    }

    std::string path_;
};

} // namespace tread::fuzz
