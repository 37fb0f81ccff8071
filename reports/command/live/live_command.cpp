// `elastocheck live`: writes a page that solves its scene again while numbers are changed (reports/live).
#include <memory>
#include <string>

#include "reports/command/live/live_page.hpp"
#include "reports/command/program/command.hpp"
#include "reports/files/files.hpp"
#include "reports/files/terminal.hpp"

namespace elastocheck::reports {
namespace {

constexpr FileKind live_file{"live page", "<!doctype html>\n<!-- elastocheck live -->"};

struct LiveRequest {
    std::string scene, output;
    Settings settings;
};

int live(const std::string& scene, const Settings& settings, const std::string& output) {
    check_may_write(output, live_file);
    write_whole(output, live_page(scene, settings), live_file);
    print("{}\n", output);
    return fine;
}

}  // namespace

const Command live_command{
    Group::pages, "live",
    "Write a page that solves the scene again while hardpoints and rates are moved",
    [](CLI::App& command) -> Run {
        const auto given = std::make_shared<LiveRequest>();
        add_scene(command, given->scene);
        add_set(command, given->settings);
        as_file(command.add_option("-o,--output", given->output, "write the page to this file"))
            ->required();
        return [given](const std::string&) {
            return live(given->scene, given->settings, given->output);
        };
    }};

}  // namespace elastocheck::reports
