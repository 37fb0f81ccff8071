// `elastocheck study`: many variants of a scene, by the Python package beside the program
// (reports/python/package/study/).
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <memory>

#include "reports/command/program/command.hpp"
#include "reports/files/files.hpp"
#include "reports/files/subprocess.hpp"

namespace elastocheck::reports {
namespace {

namespace fs = std::filesystem;

constexpr const char* program = R"(import sys
try:
    from elastocheck.study.__main__ import main
except ImportError as error:
    print(f"elastocheck: study: {error}; `./dev study` builds and installs what it needs", file=sys.stderr)
    sys.exit(2)
sys.exit(main())
)";

// The folder with the package, of the build tree or of an installed program; empty where Python has
// to find it.
std::string package_folder() {
    std::error_code failed;
    for (fs::path file = fs::read_symlink("/proc/self/exe", failed), folder = file.parent_path();
         !failed && folder != file; file = folder, folder = folder.parent_path())
        for (const char* place : {"reports/python/package", "lib/python3/dist-packages"})
            if (std::error_code unseen;
                fs::exists(folder / place / "elastocheck/study/__main__.py", unseen))
                return (folder / place).string();
    return {};
}

// Becomes the Python program, which reads the options of this command line again.
int study(const std::string& line, const Running& running) {
    const std::string python = fs::exists("/usr/bin/python3") ? "/usr/bin/python3" : "python3";
    if (std::string path = package_folder(); !path.empty()) {
        if (const char* const before = std::getenv("PYTHONPATH"); before != nullptr)
            path += ":" + std::string(before);
        ::setenv("PYTHONPATH", path.c_str(), 1);
    }
    std::vector<std::string> words = words_of(line);  // elastocheck study ...
    words.front() = "-c", words[1] = program;
    words.insert(words.begin(), python);
    words.insert(words.end(), {"--reproduce", line, "--jobs", std::to_string(running.jobs)});
    if (running.quiet) words.emplace_back("--quiet");
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    ::execvp(pointers.front(), pointers.data());
    throw FileError("study: there is no python3; `./dev study` installs it");
}

}  // namespace

const Command study_command{
    Group::change, "study",
    "Many variants of a scene, each with a row in a ledger, and the statistics of their "
    "figures; the same command goes on where it was interrupted",
    [](CLI::App& command) -> Run {
        const auto running = std::make_shared<Running>();
        as_file(command.add_option("STUDY", "file with variables, design and figures"))->required();
        as_folder(command.add_option(
                      "-o,--output",
                      "folder of the ledger (ledger.sqlite), statistics.json and study.html"))
            ->required();
        command
            .add_option("--count",
                        "number of variants, instead of that in the file; more than before "
                        "extends the study")
            ->check(CLI::Range(1, 1'000'000'000));
        command
            .add_option("--shard",
                        "compute part K of N, into ledger-K-of-N.sqlite: a job of an array, as "
                        "models/studies/study.sbatch submits it to Slurm")
            ->type_name("K/N");
        as_folder(
            command.add_option("--merge",
                               "add the rows of all shards in these folders, and compute nothing"))
            ->expected(1, -1);
        command
            .add_option("--scheduler",
                        "compute on the workers of a dask cluster (`./dev study` installs "
                        "python3-distributed)")
            ->type_name("tcp://HOST:8786");
        command.add_flag("--show")->description(
            "compute nothing, write nothing: show what there is");
        command.add_flag("--rare")->description(
            "probabilities that figures leave their limits, by FORM and importance sampling");
        as_file(command.add_option("--csv", "write variables and figures of all variants as CSV"));
        as_file(command.add_option("--hdf5", "write the same as HDF5"));
        command.add_flag("--json")->description(
            "print the document, and nothing else, to standard output");
        add_running(command, *running);
        return [running](const std::string& line) { return study(line, *running); };
    }};

}  // namespace elastocheck::reports
