#pragma once

#include <array>
#include <cstddef>
#include <string_view>

// Words of enumerations, tied to the enumerators: a table that lacks one does not compile.
namespace tread::scene
{

/// An enumerator and its word.
template<class E>
struct Spelling
{
    E           value;
    const char* word;
};

/// Whether an enumerator has this value: compilers print its name, and any other value as a cast, "(E)5".
template<auto value>
consteval bool is_enumerator()
{
    constexpr std::string_view text = __PRETTY_FUNCTION__, before = "value = ";
    static_assert(text.find(before) != text.npos);
    return text[text.find(before) + before.size()] != '(';
}

/// Number of enumerators of E, whose values count from 0.
template<class E, std::size_t count = 0>
consteval std::size_t enumerators()
{
    if constexpr (is_enumerator<static_cast<E>(count)>()) { return enumerators<E, count + 1>(); }
    else { return count; }
}

/// Whether `pairs` spell each enumerator once, in order, each with a word of its own.
template<class E, std::size_t n>
constexpr bool spell_all(const std::array<Spelling<E>, n>& pairs)
{
    for (std::size_t i = 0; i < n; ++i)
    {
        if (static_cast<std::size_t>(pairs[i].value) != i) { return false; }
        for (std::size_t j = 0; j < i; ++j)
        {
            if (std::string_view(pairs[i].word) == pairs[j].word) { return false; }
        }
    }
    return n == enumerators<E>();
}

/// Words of E; specialised once for each enumeration, by spell().
template<class E>
inline constexpr auto spellings = std::array<Spelling<E>, 0>{};

/// Makes the words of E from pairs; does not compile unless spell_all().
template<class E, std::size_t n>
consteval std::array<Spelling<E>, n> spell(const Spelling<E> (&pairs)[n])
{
    const auto table = std::to_array(pairs);
    if (!spell_all(table)) { throw "the words must spell every enumerator once, in order"; }
    return table;
}

/// Word of an enumerator.
template<class E>
constexpr const char* word_of(E value)
{
    static_assert(!spellings<E>.empty());
    return spellings<E>.at(static_cast<std::size_t>(value)).word;
}

} // namespace tread::scene
