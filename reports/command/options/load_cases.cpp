#include "reports/command/options/load_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "models/reader/document/suggestions.hpp"
#include "reports/files/csv_table.hpp"
#include "reports/given/headings.hpp"

namespace elastocheck::reports {
namespace {

using compare::CaseInput;
using compare::Unit;
using Kind = CaseInput::Kind;

constexpr std::size_t max_cases = 10000;

// A column that a scene may have.
struct KnownColumn {
    std::string name;
    CaseInput input;
    Unit unit;      // base unit
    double si = 1;  // factor from it to SI
};

std::vector<KnownColumn> known_columns(const Scene& scene) {
    std::vector<KnownColumn> list;
    const auto along_axes = [&](const std::string& stem, Kind kind, std::size_t index, Unit unit) {
        for (int axis = 0; axis < 3; ++axis)
            list.push_back({fmt::format("{}_{}", stem, "xyz"[axis]), {kind, index, axis}, unit});
    };
    for (std::size_t w = 0; w < scene.wheels.size(); ++w) {
        const std::string prefix = scene.wheels[w].name.empty() ? "" : scene.wheels[w].name + ".";
        along_axes(prefix + "patch_force", Kind::patch_force, w, Unit::newton);
        along_axes(prefix + "centre_force", Kind::centre_force, w, Unit::newton);
        along_axes(prefix + "moment", Kind::wheel_moment, w, Unit::newton_metre);
        list.push_back({prefix + "travel", {Kind::travel, w, 2}, Unit::mm, 1e-3});
    }
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
        along_axes(scene.bodies[b].name + ".force", Kind::body_force, b, Unit::newton);
    along_axes("acceleration", Kind::acceleration, 0, Unit::none);
    return list;
}

struct CaseColumn {
    bool is_name = false;
    CaseInput input{};
    double factor = 1;  // of a cell to SI
    std::string heading{};
};

CaseColumn column_of(std::string_view heading, const std::vector<KnownColumn>& known,
                     const std::string& file, int line) {
    const auto [name, unit] = split_heading(heading);
    if (name == "case") return {.is_name = true, .heading = name};
    const auto input = std::ranges::find(known, name, &KnownColumn::name);
    if (input == known.end()) {
        std::vector<std::string> names{"case"};
        for (const auto& column : known) names.push_back(column.name);
        fail_at(file, line,
                fmt::format("there is no input {}{}", reader::quote(name),
                            reader::did_you_mean(name, names, "allowed")));
    }
    if (input->input.kind == Kind::acceleration) {
        if (!unit.empty() && unit != "g")
            fail_at(
                file, line,
                fmt::format("{}: {} is not a unit of it; allowed: g", name, reader::quote(unit)));
        return {.input = input->input, .heading = name};
    }
    const auto factor = factor_of(unit, input->unit);
    if (!factor)
        fail_at(file, line,
                fmt::format("{}: {} is not a unit of it; allowed: {}", name, reader::quote(unit),
                            allowed_units(input->unit)));
    return {.input = input->input, .factor = *factor * input->si, .heading = name};
}

}  // namespace

std::vector<compare::LoadCase> read_load_cases(std::string_view csv, const std::string& file,
                                               const Scene& scene) {
    const auto known = known_columns(scene);
    std::vector<CaseColumn> columns;
    std::vector<compare::LoadCase> cases;
    const auto head = [&](const Cells& cells, int line) {
        for (const std::string& cell : cells) {
            columns.push_back(column_of(cell, known, file, line));
            if (std::ranges::count(columns, columns.back().heading, &CaseColumn::heading) > 1)
                fail_at(file, line,
                        fmt::format("two columns {}", reader::quote(columns.back().heading)));
        }
        if (std::ranges::none_of(columns, &CaseColumn::is_name))
            fail_at(file, line, "column 'case' is missing, with the name of each case");
    };
    const auto row = [&](const Cells& cells, int line) {
        compare::LoadCase load_case;
        for (std::size_t c = 0; c < columns.size(); ++c) {
            if (columns[c].is_name) {
                load_case.name = cells[c];
                continue;
            }
            const double value = number_in(cells[c], file, line, columns[c].heading);
            if (std::isnan(value)) continue;
            load_case.inputs.push_back(columns[c].input);
            load_case.inputs.back().value = columns[c].factor * value;
        }
        if (load_case.name.empty()) fail_at(file, line, "case: empty; allowed: a name");
        if (std::ranges::find(cases, load_case.name, &compare::LoadCase::name) != cases.end())
            fail_at(file, line,
                    fmt::format("case: {} is given twice", reader::quote(load_case.name)));
        try {
            compare::check_heights(load_case, scene);
        } catch (const std::invalid_argument& error) {
            fail_at(file, line, error.what());
        }
        cases.push_back(std::move(load_case));
    };
    read_csv_table(csv, file, max_cases, head, row);
    return cases;
}

}  // namespace elastocheck::reports
