// What comes from outside, each kind as a function of its bytes. It returns where the program gave an answer that is
// documented: the input understood, or refused with what is wrong. Anything else escapes (an exception of another type),
// ends the process (a signal, a sanitizer), or is a Fault: what came of the input breaks a claim that the program makes.
#pragma once

#include <array>
#include <stdexcept>
#include <string_view>

namespace elastocheck::fuzz {

struct Fault : std::logic_error {
    using std::logic_error::logic_error;
};

struct Target {
    const char* name;  // of its corpus, too
    void (*run)(std::string_view);
    bool is_json = false;  // mutated as a tree, not as lines
    std::string_view samples =
        {};  // extensions of those among tests/models/import that belong to its corpus
};

// A scene as text, up to the model that the solvers take. A line `# --set PATH=VALUE` is a setting as well.
void scene(std::string_view input);
// A baseline: judged against a sound one, both ways round, and told in every form the gate has.
void baseline(std::string_view input);
// Measured curves: compared with curves of a suspension, and told.
void measurement(std::string_view input);
// A table beside a scene.
void table(std::string_view input);
// Models of other programs.
void adm(std::string_view input);
void chrono(std::string_view input);
void subsystem(std::string_view input);  // .sub
void points(std::string_view input);     // .csv
void shark(std::string_view input);      // .shk
void view(std::string_view input);       // .cmd
void assetto(std::string_view input);    // .ini
void workbook(std::string_view input);   // the parts of an .xlsx
void property(std::string_view input);   // .bus, .spr, .bum, .reb

inline constexpr std::array targets{Target{"scene", scene},
                                    Target{"baseline", baseline, true},
                                    Target{"measurement", measurement},
                                    Target{"table", table},
                                    Target{"adm", adm, false, ".adm"},
                                    Target{"chrono", chrono, true, ".json"},
                                    Target{"subsystem", subsystem, false, ".sub"},
                                    Target{"points", points, false, ".csv"},
                                    Target{"shark", shark, false, ".shk"},
                                    Target{"view", view, false, ".cmd"},
                                    Target{"assetto", assetto, false, ".ini"},
                                    Target{"workbook", workbook},
                                    Target{"property", property, false, ".bus .spr .bum .reb"}};

// Throws Fault where the text, but for its ends of lines, holds what no name may hold.
void expect_plain(std::string_view what, std::string_view text);

}  // namespace elastocheck::fuzz
