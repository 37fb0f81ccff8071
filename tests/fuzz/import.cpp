#include <string>

#include "elastocheck/read_scene.hpp"
#include "models/import/import.hpp"
#include "models/reader/tables/property_file.hpp"
#include "tests/fuzz/targets.hpp"

namespace elastocheck::fuzz {
namespace {

void expect_place(std::string_view input, const std::string& file,
                  const importer::Options& options) {
    try {
        const importer::Imported result = importer::import_text(input, file, options);
        if (result.yaml.empty()) throw Fault("nothing was written");
    } catch (const SceneError& error) {
        if (!std::string_view(error.what()).starts_with(file + ":"))
            throw Fault("a refusal without a place: " + std::string(error.what()));
    }
}

// With what a scene cannot represent, and without; with a wheel that is hardly ever there.
void import(std::string_view input, const std::string& file) {
    for (const auto& options : {importer::Options{}, importer::Options{"", true, true},
                                importer::Options{"wheel", false, true}})
        expect_place(input, file, options);
}

}  // namespace

void adm(std::string_view input) { import(input, "model.adm"); }
void chrono(std::string_view input) { import(input, "model.json"); }
void subsystem(std::string_view input) { import(input, "model.sub"); }

namespace {

// As points alone and as mechanisms of one axle.
void mechanisms_of(std::string_view input, const std::string& file, const std::string& axes) {
    for (const char* mechanism : {"", "double_wishbone", "trailing_arm", "live_axle"})
        for (const char* axle : {"", "front"})
            for (const bool rocker : {false, true}) {
                importer::Options options{.axes = axes, .axle = axle, .as = mechanism};
                options.rocker = rocker;
                options.both_wheels = rocker;
                expect_place(input, file, options);
            }
}

}  // namespace

// As a table by its own headings and by a map.
void points(std::string_view input) {
    for (const char* columns : {"", "name=name,x=B,y=C,z=4", "name=A,side=B,x=C,y=D,z=E",
                                "name=1,left.x=2,left.y=3,left.z=4,right.x=5,right.y=6,right.z=7"})
        for (const char* unit : {"", "m"})
            expect_place(input, "points.csv",
                         {.axes = "x-rearward,y-right", .columns = columns, .unit = unit});
    mechanisms_of(input, "points.csv", "x-rearward,y-right");
}

void shark(std::string_view input) { mechanisms_of(input, "points.shk", "x-rearward,y-right"); }
void view(std::string_view input) { mechanisms_of(input, "points.cmd", "x-rearward,y-right"); }
void assetto(std::string_view input) { mechanisms_of(input, "suspensions.ini", ""); }

// The parts of a workbook, each behind a line "part NAME": as their zip file has them.
void workbook(std::string_view input) {
    const std::string file = "points.xlsx";
    const auto part = [&](const std::string& name) {
        const std::string head = "part " + name + "\n";
        const auto at = input.find(head);
        if (at == input.npos) return std::string();
        const auto text = input.substr(at + head.size());
        return std::string(text.substr(0, text.find("part xl/")));
    };
    for (const char* sheet : {"", "Front"}) try {
            const std::string csv = importer::csv_of_workbook(part, file, sheet);
            expect_place(csv, file, {.axes = "x-rearward,y-right"});
        } catch (const SceneError& error) {
            if (!std::string_view(error.what()).starts_with(file + ":"))
                throw Fault("a refusal without a place: " + std::string(error.what()));
        }
}

void property(std::string_view input) {
    try {
        const reader::PropertyFile file = reader::parse_property_file(input, "model.bus");
        for (const auto& block : file.blocks) try {
                reader::curve_rows(file, block, file.length, file.force);
            } catch (const SceneError&) {
            }
    } catch (const SceneError& error) {
        if (!std::string_view(error.what()).starts_with("model.bus:"))
            throw Fault("a refusal without a place: " + std::string(error.what()));
    }
}

}  // namespace elastocheck::fuzz
