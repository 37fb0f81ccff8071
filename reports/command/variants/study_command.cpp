// `elastocheck study`: many variants of a scene, by the Python package
// (reports/python/package/study/).
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "reports/command/program/command.hpp"
#include "reports/files/files.hpp"

namespace elastocheck::reports {
namespace {

namespace fs = std::filesystem;

constexpr const char* program = R"(import json, sys
try:
    from elastocheck.study.command import main
except ImportError as error:
    print(f"elastocheck: study: {error}; `./dev study` builds and installs what it needs", file=sys.stderr)
    sys.exit(2)
sys.exit(main(**json.loads(sys.argv[1])))
)";

// The folder with the package, of the build tree or installed; empty where Python has to find it.
std::string package_folder() {
    const fs::path package =
        beside_program({"reports/python/package/elastocheck/study/command.py",
                        "lib/python3/dist-packages/elastocheck/study/command.py"});
    return package.empty() ? "" : package.parent_path().parent_path().parent_path().string();
}

using Options = nlohmann::json;  // of elastocheck.study.run()

// Becomes the Python program.
int study(const Options& options) {
    const std::string python = fs::exists("/usr/bin/python3") ? "/usr/bin/python3" : "python3";
    if (std::string path = package_folder(); !path.empty()) {
        if (const char* const before = std::getenv("PYTHONPATH"); before != nullptr)
            path += ":" + std::string(before);
        ::setenv("PYTHONPATH", path.c_str(), 1);
    }
    ::execlp(python.c_str(), python.c_str(), "-c", program, options.dump().c_str(), nullptr);
    throw FileError("study: there is no python3; `./dev study` installs it");
}

struct StudyRequest {
    Options options;
    Running running;
    bool as_json = false;
};

}  // namespace

const Command study_command{
    Group::change, "study",
    "Many variants of a scene, each with a row in a ledger, and the statistics of their "
    "figures; the same command goes on where it was interrupted",
    [](CLI::App& command) -> Run {
        const auto request = std::make_shared<StudyRequest>();
        const auto word = [&](const char* name, const char* key, const char* description) {
            return command.add_option_function<std::string>(
                name, [request, key](const std::string& given) { request->options[key] = given; },
                description);
        };
        const auto flag = [&](const char* name, const char* key, const char* description) {
            command.add_flag_callback(
                name, [request, key] { request->options[key] = true; }, description);
        };
        as_file(word("STUDY", "file", "file with variables, design and figures"))->required();
        as_folder(word("-o,--output", "folder",
                       "folder of the ledger (ledger.sqlite), statistics.json and study.html"))
            ->required();
        command
            .add_option_function<int>(
                "--count", [request](int count) { request->options["count"] = count; },
                "number of variants, instead of that in the file; more than before extends the "
                "study")
            ->check(CLI::Range(1, 1'000'000'000));
        word("--shard", "shard",
             "compute part K of N, into ledger-K-of-N.sqlite: a job of an array, as "
             "models/studies/study.sbatch submits it to Slurm")
            ->type_name("K/N");
        as_folder(command.add_option_function<std::vector<std::string>>(
                      "--merge",
                      [request](const std::vector<std::string>& from) {
                          request->options["merge"] = from;
                      },
                      "add the rows of all shards in these folders, and compute nothing"))
            ->expected(1, -1);
        word("--scheduler", "scheduler",
             "compute on the workers of a dask cluster (`./dev study` installs "
             "python3-distributed)")
            ->type_name("tcp://HOST:8786");
        flag("--show", "show", "compute nothing, write nothing: show what there is");
        flag("--rare", "rare",
             "probabilities that figures leave their limits, by FORM and importance sampling");
        as_file(word("--csv", "csv", "write variables and figures of all variants as CSV"));
        as_file(word("--hdf5", "hdf5", "write the same as HDF5"));
        add_json(command, request->as_json);
        add_running(command, request->running);
        return [request](const std::string& line) {
            request->options.update({{"threads", request->running.jobs},
                                     {"quiet", request->running.quiet},
                                     {"as_json", request->as_json},
                                     {"reproduce", line}});
            return study(request->options);
        };
    }};

}  // namespace elastocheck::reports
