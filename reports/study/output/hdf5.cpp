#include "reports/study/output/hdf5.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "compare/variants/sampler.hpp"
#include "reports/files/files.hpp"
#include "reports/study/optional_component.hpp"
#include "reports/study/output/study_output.hpp"
#include "reports/study/run_study.hpp"

namespace elastocheck::reports {
namespace {

namespace fs = std::filesystem;

constexpr FileKind hdf5_file{"HDF5", "\x89HDF"};

void add_text(std::string& bytes, std::string_view text, std::size_t length) {
    bytes.append(text.substr(0, length));
    bytes.append(length - std::min(length, text.size()), '\0');
}
template <class Value>
void add(std::string& bytes, Value value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// Of the rows of variants or of witnesses; without variables for witnesses.
hdf5::Table table_of(const StudyFile& file, const Ledger& ledger, Ledger::Rows which) {
    using Kind = hdf5::Column::Kind;
    const std::uint64_t count = file.study.design.count;
    const bool has_variables = which == Ledger::Rows::variants;
    const std::size_t reason = std::max<std::uint64_t>(1, ledger.longest_reason(which, count));
    constexpr std::size_t outcome = 16;
    hdf5::Table table{.name = has_variables ? "variants" : "witnesses",
                      .columns = {{"variant", Kind::whole, sizeof(std::uint64_t)},
                                  {"outcome", Kind::text, outcome},
                                  {"reason", Kind::text, reason}},
                      .rows = ledger.size(which, count),
                      .next = {}};
    if (has_variables)
        for (const auto& variable : file.study.variables)
            table.columns.push_back({heading(variable)});
    for (const auto& figure : file.study.figures) table.columns.push_back({heading(figure)});
    const auto sampler = std::make_shared<compare::variants::Sampler>(file.study);
    table.next = [&file, &ledger, which, count, has_variables, reason, sampler,
                  first = std::uint64_t{0}](std::string& bytes) mutable {
        for (; bytes.empty() && first < count; first += batch_size) {
            const std::uint64_t end = std::min(first + batch_size, count);
            Eigen::MatrixXd values;
            if (has_variables) values = sampler->values(first, end - first);
            ledger.each_row(which, first, end, [&](const LedgerRow& row) {
                add(bytes, row.k);
                add_text(bytes, name(row.figures.outcome), outcome);
                add_text(bytes, row.figures.reason, reason);
                if (has_variables)
                    for (const double value : values.row(static_cast<Eigen::Index>(row.k - first)))
                        add(bytes, value);
                for (const double value : row.figures.values) add(bytes, value);
            });
        }
    };
    return table;
}

}  // namespace

void write_study_hdf5(const StudyFile& file, const Ledger& ledger, const std::string& content_hash,
                      const fs::path& output) {
    const auto& module = optional_component<hdf5::Functions>(
        hdf5::module_file, hdf5::module_symbol, "--hdf5 needs HDF5, an optional component",
        "install the package elastocheck-hdf5, or libhdf5-dev and build again");
    check_may_write(output, hdf5_file);
    const fs::path temporary = temporary_beside(output);
    try {
        module.write(temporary.string(),
                     {table_of(file, ledger, Ledger::Rows::variants),
                      table_of(file, ledger, Ledger::Rows::witnesses)},
                     {{"schema", "elastocheck/variants/1"},
                      {"study", file.identity.study},
                      {"scene", file.identity.scene},
                      {"version", fmt::format("{}", fmt::join(ledger.versions(), ", "))},
                      {"content", content_hash}});
        fs::rename(temporary, output);
    } catch (const std::exception& error) {
        std::error_code ignored;
        fs::remove(temporary, ignored);
        throw FileError(fmt::format("{}: {}", output.string(), error.what()));
    }
}

}  // namespace elastocheck::reports
