// The module elastocheck-hdf5.so: writes tables by HDF5.
#include <hdf5.h>

#include <algorithm>
#include <stdexcept>

#include "reports/study/output/hdf5.hpp"

namespace elastocheck::reports::hdf5 {
namespace {

std::string message_of_hdf5() {
    std::string message = "HDF5 failed";
    H5Ewalk2(
        H5E_DEFAULT, H5E_WALK_UPWARD,
        [](unsigned depth, const H5E_error2_t* error, void* into) -> herr_t {
            if (depth == 0) *static_cast<std::string*>(into) = error->desc;
            return 0;
        },
        &message);
    return message;
}

// Identifiers and codes of HDF5 are negative where it failed.
template <class Code>
Code checked(Code code) {
    if (code < 0) throw std::runtime_error(message_of_hdf5());
    return code;
}

class Handle {
  public:
    Handle(hid_t id, herr_t (*close)(hid_t)) : id_(checked(id)), close_(close) {}
    ~Handle() { close_(id_); }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    operator hid_t() const { return id_; }

  private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

Handle text_type(std::size_t bytes) {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, bytes);
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    H5Tset_cset(type, H5T_CSET_UTF8);
    return {type, H5Tclose};
}

void write_table(hid_t file, const Table& table) {
    std::size_t size = 0;
    for (const Column& column : table.columns) size += column.bytes;
    const Handle type(H5Tcreate(H5T_COMPOUND, size), H5Tclose);
    std::size_t at = 0;
    for (const Column& column : table.columns) {
        if (column.kind == Column::Kind::text) {
            const Handle text = text_type(column.bytes);
            checked(H5Tinsert(type, column.name.c_str(), at, text));
        } else {
            const bool is_whole = column.kind == Column::Kind::whole;
            checked(H5Tinsert(type, column.name.c_str(), at,
                              is_whole ? H5T_STD_U64LE : H5T_IEEE_F64LE));
        }
        at += column.bytes;
    }
    const hsize_t rows = table.rows;
    const Handle space(H5Screate_simple(1, &rows, nullptr), H5Sclose);
    const Handle set(
        H5Dcreate2(file, table.name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose);
    std::string bytes;
    for (hsize_t first = 0; first < rows;) {
        bytes.clear();
        table.next(bytes);
        const hsize_t count = bytes.size() / size;
        if (count == 0) throw std::runtime_error(table.name + ": fewer rows than announced");
        const Handle part(H5Screate_simple(1, &count, nullptr), H5Sclose);
        checked(H5Sselect_hyperslab(space, H5S_SELECT_SET, &first, nullptr, &count, nullptr));
        checked(H5Dwrite(set, type, part, space, H5P_DEFAULT, bytes.data()));
        first += count;
    }
}

void write(const std::string& name, const std::vector<Table>& tables,
           const Attributes& attributes) {
    checked(H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr));
    const hid_t file = checked(H5Fcreate(name.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
    try {
        for (const auto& [key, value] : attributes) {
            const Handle type = text_type(std::max<std::size_t>(1, value.size()));
            const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
            const Handle attribute(
                H5Acreate2(file, key.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
            checked(H5Awrite(attribute, type, value.c_str()));
        }
        for (const Table& table : tables) write_table(file, table);
    } catch (...) {
        H5Fclose(file);
        throw;
    }
    checked(H5Fclose(file));  // what was buffered is written here
}

}  // namespace
}  // namespace elastocheck::reports::hdf5

extern "C" const elastocheck::reports::hdf5::Functions* elastocheck_hdf5_functions() {
    static const elastocheck::reports::hdf5::Functions functions{elastocheck::reports::hdf5::write};
    return &functions;
}
