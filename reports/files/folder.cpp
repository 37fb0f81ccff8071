#include "reports/files/folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <set>
#include <sstream>

namespace elastocheck::reports {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& why) {
    throw FileError(fmt::format("{}: {}", path.string(), why));
}

// All files at any depth; links are files.
std::vector<std::string> files_in(const fs::path& folder) {
    std::vector<std::string> files;
    std::error_code failed;
    for (auto at = fs::recursive_directory_iterator(folder, failed); !failed && at != fs::end(at);
         at.increment(failed))
        if (!at->is_directory() || at->is_symlink())
            files.push_back(at->path().lexically_relative(folder).generic_string());
    if (failed) fail(folder, fmt::format("cannot be read: {}", failed.message()));
    std::ranges::sort(files);
    return files;
}

// Throws FileError unless every file of the folder is a regular file of its manifest.
void check_all_listed(const fs::path& folder) {
    std::set<std::string> listed;
    const auto is_regular = [&](const std::string& file) {
        return fs::is_regular_file(fs::symlink_status(folder / file));
    };
    if (is_regular(manifest)) {
        std::istringstream in(read_whole(folder / manifest));
        std::string line;
        if (std::getline(in, line) && line == manifest_head) {
            listed.insert(manifest);
            while (std::getline(in, line))  // older versions wrote "HASH  PATH"
                listed.insert(line.substr(line.find("  ") == 16 ? 18 : 0));
        }
    }
    for (const auto& file : files_in(folder))
        if (!listed.contains(file) || !is_regular(file))
            fail(
                folder / file,
                "is not a part of a report, and replacing the folder would lose it; choose another "
                "folder");
}

// The folder after resolving links and checking that it may be replaced.
fs::path resolved(const fs::path& folder) {
    std::error_code failed;
    if (folder.empty()) fail("''", "is not a folder name");
    fs::path target = fs::weakly_canonical(fs::absolute(folder), failed);
    if (failed) fail(folder, failed.message());
    if (!target.has_filename()) target = target.parent_path();
    if (!target.has_filename())
        fail(folder, "is the root of a file system; choose a folder below it");
    const auto status = fs::status(target, failed);
    if (fs::is_symlink(fs::symlink_status(target, failed)) &&
        status.type() == fs::file_type::not_found)
        fail(folder, "is a symbolic link that leads nowhere");
    if (status.type() == fs::file_type::not_found) return target;
    if (status.type() == fs::file_type::none) fail(folder, failed.message());
    if (status.type() != fs::file_type::directory)
        fail(folder, "is a file; a folder is written here");
    check_all_listed(target);
    return target;
}

}  // namespace

void Staging::check(const fs::path& folder) { (void)resolved(folder); }

Staging::Staging(const fs::path& folder) : target_(resolved(folder)) {
    std::error_code failed;
    fs::create_directories(target_.parent_path(), failed);
    if (failed) fail(folder, fmt::format("cannot make its folder: {}", failed.message()));
    staging_ = temporary_beside(target_);
    if (!fs::create_directory(staging_, failed))
        fail(folder, fmt::format("cannot be written: {}", failed.message()));
}

Staging::~Staging() {
    std::error_code ignored;
    fs::remove_all(staging_, ignored);
}

void Staging::publish() {
    std::string list = fmt::format("{}\n", manifest_head);
    for (const auto& file : files_in(staging_)) list += file + "\n";
    write_staged(staging_ / manifest, list);
    if (::rename(staging_.c_str(), target_.c_str()) == 0) return;
    // The target is not empty: the two are exchanged, and the destructor removes the older one.
    if ((errno != ENOTEMPTY && errno != EEXIST) ||
        ::renameat2(AT_FDCWD, staging_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) != 0)
        fail(target_, fmt::format("cannot be written: {}", std::strerror(errno)));
}

void write_folder(const fs::path& folder, const std::vector<NamedContent>& files) {
    Staging staging(folder);
    for (const auto& [name, content] : files) write_staged(staging.path() / name, content);
    staging.publish();
}

}  // namespace elastocheck::reports
