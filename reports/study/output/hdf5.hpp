// Rows of a ledger as HDF5, which h5py and pandas read without help.
//
//   /variants    one row for every variant of the ledger: variant, outcome, reason, variables, figures
//   /witnesses   variant, outcome, reason, figures by the equilibrium leg
//
// Both are one-dimensional and of a compound type; names of columns are those of the CSV file, with
// units. Numbers are little-endian doubles, NaN where there is none; texts have a fixed length. The
// attributes of the file are schema, study, scene, version and content. HDF5 is an optional
// component, the module elastocheck-hdf5.so (hdf5_module.cpp, where alone its header is included).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "reports/study/ledger.hpp"
#include "reports/study/study_file.hpp"

namespace elastocheck::reports {

// Throws FileError, and std::invalid_argument without the module.
void write_study_hdf5(const StudyFile& file, const Ledger& ledger, const std::string& content_hash,
                      const std::filesystem::path& output);

// What the module provides, by its only symbol.
namespace hdf5 {
struct Column {
    enum class Kind { whole, real, text };  // std::uint64_t, double, characters
    std::string name;
    Kind kind = Kind::real;
    std::size_t bytes = sizeof(double);
};
struct Table {
    std::string name;
    std::vector<Column> columns;
    std::uint64_t rows = 0;
    // Appends rows to the bytes, the cells side by side; as many calls as it takes.
    std::function<void(std::string& bytes)> next;
};
using Attributes = std::vector<std::pair<std::string, std::string>>;
struct Functions {
    // Throws std::runtime_error.
    void (*write)(const std::string& file, const std::vector<Table>& tables,
                  const Attributes& attributes);
};
inline constexpr const char* module_file = "elastocheck-hdf5.so";
inline constexpr const char* module_symbol = "elastocheck_hdf5_functions";
}  // namespace hdf5

}  // namespace elastocheck::reports
