#include "reports/command/grammar/command.hpp"

#include "models/overloaded.hpp"
#include "models/reader/document/limits.hpp"

namespace elastocheck::reports {

Value value_of(const Option& option) {
    return std::visit(overloaded{[](const Flag&) {
                                     return Value{Value::Kind::none, "", {}};
                                 },
                                 [](const Text& text) { return text.value; },
                                 [](const TextList& list) { return list.value; },
                                 [](const Integer&) { return Value{.name = "INT"}; },
                                 [](const IntegerList&) { return Value{.name = "INT"}; },
                                 [](const RealNumber&) { return Value{.name = "FLOAT"}; },
                                 [](const Settings*) { return Value{.name = "PATH=VALUE"}; }},
                      option.target);
}

Option scene_option(std::string& file) {
    return {"SCENE", Text{&file, a_file()}, "scene file (YAML)", true};
}

Option set_option(Settings& settings) {
    return {
        "--set", &settings,
        "change a value of the scene, in the file's units: --set points.tie_rod_inner.z=-0.055"};
}

Option json_option(bool& wanted) {
    return {"--json", Flag{&wanted},
            "one JSON document on standard output, and nothing else there"};
}

Option keep_all_option(bool& wanted) {
    return {"--keep-all", Flag{&wanted}, "solve the whole scene, also what no output depends on"};
}

Option every_option(int& every) {
    return {"--every", Integer{&every, 1, reader::most_steps},
            "only every N-th step's point of each side from the start, and the last"};
}

Option output_option(std::string& folder, const std::string& description) {
    return {"-o,--output", Text{&folder, a_folder()}, description};
}

}  // namespace elastocheck::reports
