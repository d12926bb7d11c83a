#include "edited_file.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <vector>

#include <hdf5.h>

#include "require.hpp"

namespace tread::fuzz
{
namespace
{

/// One change. What does not fit the place that it meets does nothing.
struct Edit
{
    static constexpr std::size_t bytes = 13;

    /// Modulo 8: 0 to 4 change a value, 5 adds or removes rows, 6 removes a data set, 7 changes a value of an
    /// attribute. An eighth of it, modulo 4, says how values change: overwritten, copied from another place, shifted,
    /// one bit.
    std::uint8_t  kind;
    std::uint16_t object; ///< of the data sets, or of the attributes, modulo their number
    std::uint16_t place;  ///< of the values, modulo their number
    std::uint64_t value;

    static Edit from(const std::uint8_t* data)
    {
        Edit edit{};
        edit.kind = data[0];
        std::memcpy(&edit.object, data + 1, 2);
        std::memcpy(&edit.place, data + 3, 2);
        std::memcpy(&edit.value, data + 5, 8);
        return edit;
    }
};

/// A data set or an attribute, read whole.
struct Values
{
    hid_t                     type;
    std::vector<hsize_t>      shape;
    std::vector<std::uint8_t> bytes;

    std::size_t width() const { return H5Tget_size(type); }
    std::size_t count() const { return bytes.size() / width(); }
};

Values empty_values(hid_t type, hid_t space)
{
    Values values{type, std::vector<hsize_t>(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space))), {}};
    H5Sget_simple_extent_dims(space, values.shape.data(), nullptr);
    values.bytes.resize(values.width() * static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
    H5Sclose(space);
    return values;
}

/// Overwrites, shifts or exchanges values.
void change(Values& values, const Edit& edit)
{
    if (values.bytes.empty() || H5Tis_variable_str(values.type) > 0) { return; }
    const std::size_t width = values.width();
    std::uint8_t*     at    = values.bytes.data() + width * (edit.place % values.count());
    if (H5Tget_class(values.type) == H5T_STRING)
    {
        at[edit.value % width] = static_cast<std::uint8_t>(edit.value >> 32U);
        return;
    }
    switch (edit.kind / 8 % 4)
    {
    case 0:
        std::memcpy(at, &edit.value, std::min(width, sizeof edit.value));
        return;
    case 1:
    {
        const std::uint8_t* other = values.bytes.data() + width * (edit.value % values.count());
        std::memmove(at, other, width);
        return;
    }
    case 2:
    {
        std::uint64_t word = 0;
        std::memcpy(&word, at, std::min(width, sizeof word));
        word += static_cast<std::uint64_t>(static_cast<std::int8_t>(edit.value));
        std::memcpy(at, &word, std::min(width, sizeof word));
        return;
    }
    default:
        at[edit.value % width] ^= static_cast<std::uint8_t>(1U << (edit.value >> 8U) % 8U);
    }
}

/// An HDF5 file that is open for changes.
class EditedFile
{
public:
    /// `left_alone`: name of a data set that stays as it is.
    EditedFile(const std::string& path, const std::string& left_alone)
        : file_(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT))
    {
        require(file_ >= 0);
        H5Ovisit(file_, H5_INDEX_NAME, H5_ITER_INC, &EditedFile::note, this);
        data_sets_.erase(std::remove(data_sets_.begin(), data_sets_.end(), left_alone), data_sets_.end());
    }
    ~EditedFile() { require(H5Fclose(file_) >= 0); }
    EditedFile(const EditedFile&)            = delete;
    EditedFile& operator=(const EditedFile&) = delete;

    void apply(const Edit& edit)
    {
        if (edit.kind % 8 == 7)
        {
            if (!attributes_.empty()) { change_attribute(attributes_[edit.object % attributes_.size()], edit); }
            return;
        }
        if (data_sets_.empty()) { return; }
        const std::size_t at = edit.object % data_sets_.size();
        switch (edit.kind % 8)
        {
        case 5:
            change_rows(data_sets_[at], static_cast<int>(edit.value % 5) - 2);
            return;
        case 6:
            H5Ldelete(file_, data_sets_[at].c_str(), H5P_DEFAULT);
            data_sets_.erase(data_sets_.begin() + static_cast<std::ptrdiff_t>(at));
            return;
        default:
            change_values(data_sets_[at], edit);
        }
    }

private:
    struct Attribute
    {
        std::string object, name;
    };

    static herr_t note(hid_t file, const char* name, const H5O_info_t* info, void* self)
    {
        auto& file_of = *static_cast<EditedFile*>(self);
        if (info->type == H5O_TYPE_DATASET) { file_of.data_sets_.emplace_back(name); }
        const hid_t object = H5Oopen(file, name, H5P_DEFAULT);
        for (int i = 0; i < H5Aget_num_attrs(object); ++i)
        {
            char        text[256] = {};
            const hid_t attribute = H5Aopen_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_INC, static_cast<hsize_t>(i),
                                                   H5P_DEFAULT, H5P_DEFAULT);
            H5Aget_name(attribute, sizeof text, text);
            H5Aclose(attribute);
            file_of.attributes_.push_back({name, text});
        }
        H5Oclose(object);
        return 0;
    }

    void change_attribute(const Attribute& which, const Edit& edit)
    {
        const hid_t attribute =
            H5Aopen_by_name(file_, which.object.c_str(), which.name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
        if (attribute < 0) { return; } // its data set has gone
        Values values = empty_values(H5Aget_type(attribute), H5Aget_space(attribute));
        if (H5Tis_variable_str(values.type) <= 0 && H5Aread(attribute, values.type, values.bytes.data()) >= 0)
        {
            change(values, edit);
            H5Awrite(attribute, values.type, values.bytes.data());
        }
        H5Tclose(values.type);
        H5Aclose(attribute);
    }

    Values read(hid_t data_set)
    {
        Values values = empty_values(H5Dget_type(data_set), H5Dget_space(data_set));
        if (!values.bytes.empty())
        {
            H5Dread(data_set, values.type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.bytes.data());
        }
        return values;
    }

    void change_values(const std::string& name, const Edit& edit)
    {
        const hid_t data_set = H5Dopen2(file_, name.c_str(), H5P_DEFAULT);
        Values      values   = read(data_set);
        change(values, edit);
        if (!values.bytes.empty())
        {
            H5Dwrite(data_set, values.type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.bytes.data());
        }
        H5Tclose(values.type);
        H5Dclose(data_set);
    }

    /// Takes rows away or adds some like the last one, and says so where the data set does.
    void change_rows(const std::string& name, int by)
    {
        const hid_t               data_set = H5Dopen2(file_, name.c_str(), H5P_DEFAULT);
        Values                    values   = read(data_set);
        std::vector<std::int64_t> first    = first_rows_of(data_set);
        H5Dclose(data_set);
        if (!values.shape.empty() && values.shape[0] > 2)
        {
            const std::size_t row = values.bytes.size() / values.shape[0];
            values.shape[0] += static_cast<hsize_t>(by);
            std::vector<std::uint8_t> last(values.bytes.end() - static_cast<std::ptrdiff_t>(row), values.bytes.end());
            values.bytes.resize(row * values.shape[0]);
            for (int i = 0; i < by; ++i)
            {
                std::copy(last.begin(), last.end(), values.bytes.end() - static_cast<std::ptrdiff_t>(row) * (i + 1));
            }
            if (!first.empty()) { first.back() = static_cast<std::int64_t>(values.shape[0]); }
            replace(name, values, first);
        }
        H5Tclose(values.type);
    }

    static std::vector<std::int64_t> first_rows_of(hid_t data_set)
    {
        if (H5Aexists(data_set, "first_row") <= 0) { return {}; }
        const hid_t               attribute = H5Aopen(data_set, "first_row", H5P_DEFAULT);
        const Values              values    = empty_values(H5Aget_type(attribute), H5Aget_space(attribute));
        std::vector<std::int64_t> first(values.count());
        H5Aread(attribute, H5T_NATIVE_INT64, first.data());
        H5Tclose(values.type);
        H5Aclose(attribute);
        return first;
    }

    void replace(const std::string& name, const Values& values, const std::vector<std::int64_t>& first)
    {
        H5Ldelete(file_, name.c_str(), H5P_DEFAULT);
        const hid_t space = H5Screate_simple(static_cast<int>(values.shape.size()), values.shape.data(), nullptr);
        const hid_t made  = H5Dcreate2(file_, name.c_str(), values.type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
        require(made >= 0);
        H5Dwrite(made, values.type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.bytes.data());
        if (!first.empty())
        {
            const hsize_t count     = first.size();
            const hid_t   row       = H5Screate_simple(1, &count, nullptr);
            const hid_t   attribute = H5Acreate2(made, "first_row", H5T_STD_I64LE, row, H5P_DEFAULT, H5P_DEFAULT);
            H5Awrite(attribute, H5T_NATIVE_INT64, first.data());
            H5Aclose(attribute);
            H5Sclose(row);
        }
        H5Dclose(made);
        H5Sclose(space);
    }

    hid_t                    file_;
    std::vector<std::string> data_sets_;
    std::vector<Attribute>   attributes_;
};

} // namespace

void write_edited(const std::string& original, const std::string& copy, const std::uint8_t* data, std::size_t size,
                  const std::string& left_alone)
{
    std::filesystem::copy_file(original, copy, std::filesystem::copy_options::overwrite_existing);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    EditedFile file(copy, left_alone);
    for (std::size_t at = 0; at + Edit::bytes <= size; at += Edit::bytes) { file.apply(Edit::from(data + at)); }
}

std::string originals()
{
    const char* folder = std::getenv("TREAD_FUZZ_ORIGINALS");
    require(folder != nullptr);
    return folder;
}

} // namespace tread::fuzz
