// The solver of a live page: opens a scene, solves it with changed numbers by the series, writes it back. The same
// code runs in the page as WebAssembly (reports/live/wasm) and natively in tests.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/comparison/trim.hpp"
#include "elastocheck/read_scene.hpp"
#include "models/reader/parsed_scene.hpp"

namespace elastocheck::live {

struct Prepared;  // prepared.hpp
struct Shared;    // engine.cpp

struct Session {
    std::string text, name;  // of the scene, and of its file for messages
    std::optional<reader::ParsedScene> parsed;
    compare::TrimStart trim;  // of the last solve, from which the next one starts
    // of the last solve: structure of its model, analyses of the models of its branches
    std::vector<int> structure = {};
    std::vector<std::shared_ptr<const Shared>> shared = {};
    std::shared_ptr<Prepared> prepared = {};  // for calls about the same numbers
};

// Reads a scene and keeps it in the session; `folder` is that of the files it refers to, empty: none.
// Throws SceneError. The answer:
//   title, warnings      of the reader, "file:line: field: ..."
//   numbers              path, value, unit of every number of the file, as written
//   points               hardpoints [mm]: name, position
//   branches             name, unit, from, to [unit], steps; usual: figures that are shown first over it
//   channels             name, unit, kind, main, definition, undefined, of all that solve() returns; figure: the
//                        name without its owner; wheel: position of the wheel whose figure it is, else null
nlohmann::ordered_json open(Session& session, std::string_view text, const std::string& name,
                            const reader::Folder& folder = std::nullopt);

struct Request {
    // What is on the screen while a number is moved.
    struct Shown {
        std::vector<std::string> everywhere;  // characteristics that are read at every point
        std::vector<double> at;  // parameters [unit of the branch] at which all of them are
    };
    std::vector<Setting> settings;
    int points = 40;             // equal increments of the parameter over a branch, > 0
    std::optional<Shown> shown;  // only this is computed; empty: everything is
    bool published = false;      // whether the published method is computed too
    std::string only;            // name of a branch: the others are not solved; empty: all are
};

// Trims and solves all branches by the power series. Throws SceneError, std::invalid_argument.
// With `shown` it starts from the elimination orders and the settled start of the last solve, if the
// models differ in their numbers only; and the response of a wheel on a jack follows from that of the
// free wheel, which changes it by 1e-10.
// `head`:
//   trouble   why there is no result: a trim that is not reached; else absent
//   trim      adjusted: name, by, unit, makes; null without a trim
//   channels  names; normally those of open()
//   drawing   drawing_json() of the trimmed design position
//   branches  name, unit, outcome, detail, idle: motions that nothing resists, as text,
//             points, start: index of the point at a = 0, at: index of its first number, published: outcome, detail,
//             steps, points, at; null unless requested
// `numbers`, per point of a branch in ascending order of the parameter: parameter, channels, positions of the drawing's
// points [mm], spin axes of the wheels, points_of_figures() [mm].
// Of a point of the published method: parameter, channels. NaN: not computed; infinite: undefined.
struct Answer {
    nlohmann::ordered_json head;
    std::vector<double> numbers;
};
Answer solve(Session& session, const Request& request);

// The scene's text with these values (rewrite_scene()).
std::string rewrite(const Session& session, const std::vector<Setting>& settings);

// {"settings": [[path, value], ...], "points": 40, "shown": {"everywhere": [name, ...], "at": [0]},
// "published": false, "only": "travel"}; throws std::invalid_argument for anything else.
Request request_of(std::string_view json);

}  // namespace elastocheck::live
