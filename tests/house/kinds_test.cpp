// A new kind must not compile and be forgotten. Code asks one kind only where it implements the
// mechanics or the file format of that kind; elsewhere it visits all kinds or uses the members
// listed in models/kinds.hpp.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

namespace {

namespace fs = std::filesystem;

// Kinds of joints, constraints, elements, laws, loads and driven quantities.
const std::string kinds =
    "Spherical|Revolute|Universal|Cylindrical|Translational|Planar|Fixed|Distance|InPlane|InLine|"
    "Perpendicular|Parallel|Angle|CoincidentPoints|PointInPlane|PerpendicularDirections|"
    "DistanceBetween|DirectionAtAngle|AxialSpring|Bushing|LinearRate|Curve|LinearStiffness|PerAxis|"
    "DeadForce|DeadMoment|FollowerForce|FollowerMoment|BrakeForce|Load|Motion|FreeLength|Preload";

// The files that implement one kind, and what for.
const std::set<std::string> implement_a_kind{
    "include/elastocheck/model.hpp",                        // rows of a constraint
    "models/kinds.hpp",                                     // the list itself
    "models/compile/welds.cpp",                             // fixed joints
    "models/compile/links.cpp",                             // spherical joints of a link
    "models/import/export/export_adm.cpp",                  // weights as masses
    "models/import/export/export_chrono.cpp",               // stops between the ends of a spring
    "models/vanishing_length.cpp",                          // lengths above zero
    "recursive/linear_response.cpp",                        // a disturbance, not a driver
    "recursive/residuals.cpp",                              // lengths above zero
    "recursive/series/term_values.hpp",                     // series of the laws
    "reference/certificate/interval/laws.hpp",              // laws in intervals
    "reference/certificate/statement/system.cpp",           // isotropic bushings
    "reference/energy/potential/potential.cpp",             // rotation of bushings
    "reference/energy/solve.cpp",                           // lengths above zero
    "reference/equilibrium/continuation/continuation.cpp",  // springs and links that reverse
    "reference/equilibrium/residuals.cpp",                  // the opposite angle
    "reference/equilibrium/solve.cpp",                      // lengths above zero
    "reference/equilibrium/statement/system.cpp",           // angles of bushings and joints
    "compare/comparison/elements.cpp",                      // axial force of links
    "compare/outputs/wheel_load.cpp",                       // jacks
    "compare/proofs/multiple_equilibria.cpp",               // axes that point the other way
    "compare/studies/findings.cpp",                         // tyres, lifting forces and jacks
    "compare/studies/formulations.cpp",                     // formulations of bushings
    "reports/document/drawing.cpp",                         // drives as planes
};

bool asks_one_kind(const std::string& text) {
    static const std::regex question("(get_if|holds_alternative)<(elastocheck::)?(" + kinds + ")>");
    return std::regex_search(text, question);
}

TEST(Kinds, KindsAreVisitedExhaustivelyOrByMembers) {
    const fs::path root = ELASTOCHECK_ROOT;
    std::set<std::string> unused = implement_a_kind;
    for (const char* folder : {"include", "models", "recursive", "reference", "compare", "reports"})
        for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
            const auto extension = entry.path().extension();
            if (extension != ".cpp" && extension != ".hpp") continue;
            std::ifstream file(entry.path());
            const std::string text(std::istreambuf_iterator<char>(file), {});
            const std::string path = fs::relative(entry.path(), root).generic_string();
            if (!asks_one_kind(text)) continue;
            EXPECT_TRUE(implement_a_kind.contains(path))
                << path << ": get_if or holds_alternative on one kind forgets a new kind; use "
                << "std::visit over all kinds or the members in models/kinds.hpp";
            unused.erase(path);
        }
    for (const auto& path : unused) ADD_FAILURE() << path << " asks no single kind any more";
}

TEST(Kinds, QueryOfASingleKindIsDetected) {
    EXPECT_TRUE(asks_one_kind("std::get_if<AxialSpring>(&kind)"));
    EXPECT_TRUE(asks_one_kind("std::holds_alternative<elastocheck::Curve>(law)"));
    EXPECT_FALSE(asks_one_kind("std::get_if<recursive::Series>(&method.kind)"));
    EXPECT_FALSE(asks_one_kind("member<Formulation>(kind)"));
}

}  // namespace
