#include "scene/resolved.hpp"

#include <cstdint>

#include "scene/keys.hpp"

namespace tread::scene
{
namespace
{

template<class T>
std::string write_member(const std::string& table, const Keys<T>& keys, const T& object)
{
    return "\n[" + table + "]\n" + write_keys(keys, object, "\n") + "\n";
}

template<class T>
std::string write_member(const std::string& table, const Keys<T>& keys, const std::vector<T>& objects)
{
    std::string text;
    for (const auto& object : objects) { text += "\n[[" + table + "]]\n" + write_keys(keys, object, "\n") + "\n"; }
    return text;
}

/// FNV-1a hash (Fowler, Noll, Vo) with 64 bits (RFC 9923).
std::uint64_t fnv1a(const std::string& text)
{
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const char letter : text)
    {
        hash ^= static_cast<unsigned char>(letter);
        hash *= 0x100000001b3u;
    }
    return hash;
}

} // namespace

std::string resolved_toml(const Scene& scene)
{
    std::string text = write_keys(scene_keys(), scene, "\n") + "\n";
    for_each_table([&](const std::string& table, const char*, auto member, const auto& keys)
                   { text += write_member(table, keys, scene.*member); });
    return text;
}

std::string scene_hash(const Scene& scene)
{
    Scene computed = scene;
    computed.title.clear();
    computed.reference = {};
    return fmt::format("{:016x}", fnv1a(resolved_toml(computed)));
}

} // namespace tread::scene
