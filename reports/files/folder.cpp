#include "reports/files/folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "reports/files/provenance.hpp"

namespace elastocheck::reports {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& why) {
    throw FileError(fmt::format("{}: {}", path.string(), why));
}

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

// Marks a staging folder until it is published: all its content was written by this program.
constexpr const char* marker = ".elastocheck-staging";

std::string line_of(const fs::path& folder, const std::string& file) {
    return fmt::format("{}  {}", input_hash(read_whole(folder / file)), file);
}

// Lines of the manifest; empty for a file of that name made by another program.
std::set<std::string> listed_in(const fs::path& folder) {
    std::set<std::string> lines;
    if (!fs::is_regular_file(fs::symlink_status(folder / manifest))) return lines;
    std::istringstream in(read_whole(folder / manifest));
    std::string line;
    if (!std::getline(in, line) || line != manifest_head) return lines;
    while (std::getline(in, line)) lines.insert(line);
    return lines;
}

bool is_ours(const fs::path& folder, const std::string& file, const std::set<std::string>& listed) {
    return fs::is_regular_file(fs::symlink_status(folder / file)) &&
           listed.contains(line_of(folder, file));
}

// Subfolders at any depth, the deepest first.
std::vector<std::string> folders_in(const fs::path& folder) {
    std::vector<std::string> folders;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_directory() && !entry.is_symlink())
            folders.push_back(entry.path().lexically_relative(folder).generic_string());
    std::ranges::sort(folders, std::ranges::greater{},
                      [](const auto& name) { return name.size(); });
    return folders;
}

// Whether some file of the manifest is in the folder `inner` or below it.
bool is_ours(const std::string& inner, const std::set<std::string>& listed) {
    return std::ranges::any_of(
        listed, [&](const auto& line) { return line.find("  " + inner + "/") == line.find("  "); });
}

// Throws FileError unless every file of the folder is on its manifest with unchanged content, and
// every subfolder contains such a file.
void check_all_ours(const fs::path& folder) {
    const auto files = files_in(folder);
    const auto listed = listed_in(folder);
    for (const auto& inner : folders_in(folder))
        if (!is_ours(inner, listed))
            fail(folder / inner,
                 "is no part of a report, and replacing the folder would lose it; choose another "
                 "folder");
    for (const auto& file : files) {
        if (is_ours(folder, file, listed) || (file == manifest && !listed.empty())) continue;
        const bool changed = std::ranges::any_of(
            listed, [&](const auto& line) { return line.ends_with("  " + file); });
        fail(folder / file, changed ? "was changed since elastocheck wrote it, and replacing the "
                                      "folder would lose that; choose "
                                      "another folder, or remove this one"
                                    : "is no part of a report, and replacing the folder would lose "
                                      "it; choose another folder");
    }
}

// Identity of a folder, to detect its replacement; empty if it does not exist.
std::optional<std::pair<dev_t, ino_t>> identity(const fs::path& folder) {
    struct stat entry {};
    if (::stat(folder.c_str(), &entry) != 0) return std::nullopt;
    return std::pair{entry.st_dev, entry.st_ino};
}

// The same for a folder that another run may replace during the check: the check is then repeated.
void check_ours(const fs::path& folder) {
    for (;;) {
        const auto before = identity(folder);
        try {
            return check_all_ours(folder);
        } catch (const std::exception&) {
            if (identity(folder) == before) throw;
        }
    }
}

// Removes the files accepted by check_ours, then empty folders; the manifest last, so that an
// interrupted removal leaves a recognisable folder.
void remove_ours(const fs::path& folder) {
    std::error_code ignored;
    if (fs::is_regular_file(fs::symlink_status(folder / marker))) {
        for (const auto& entry : fs::directory_iterator(folder, ignored))
            if (entry.path().filename() != marker) fs::remove_all(entry.path(), ignored);
        // last: an interrupted removal leaves a recognisable folder
        fs::remove(folder / marker, ignored);
        ::rmdir(folder.c_str());
        return;
    }
    const auto listed = listed_in(folder);
    for (const auto& file : files_in(folder))
        if (file != manifest && is_ours(folder, file, listed)) fs::remove(folder / file, ignored);
    for (const auto& inner : folders_in(folder))
        if (is_ours(inner, listed)) ::rmdir((folder / inner).c_str());
    if (!listed.empty() && files_in(folder).size() == 1) fs::remove(folder / manifest, ignored);
    ::rmdir(folder.c_str());  // fails if the folder is not empty
}

std::string staging_prefix(const fs::path& target) {
    return fmt::format(".{}.elastocheck-", target.filename().string());
}

int lock_folder(const fs::path& folder) {
    const int lock = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock >= 0 && ::flock(lock, LOCK_EX | LOCK_NB) != 0) {
        const int error = errno;
        ::close(lock);
        errno = error;
        return -1;
    }
    return lock;
}

// Removes staging folders of killed runs. A living owner holds a lock on its folder.
void remove_abandoned(const fs::path& target) {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(target.parent_path(), ignored)) {
        if (!entry.path().filename().string().starts_with(staging_prefix(target)) ||
            entry.is_symlink() || !entry.is_directory())
            continue;
        const int lock = lock_folder(entry.path());
        if (lock < 0) continue;
        try {
            remove_ours(entry.path());
            // a folder of another program, or an unreadable one: kept
        } catch (const std::exception&) {
        }
        ::close(lock);
    }
}

void flush_folder(const fs::path& folder) {
    const int open = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (open < 0) return;
    ::fsync(open);
    ::close(open);
}

// The folder after resolving links and checking that it may be replaced.
fs::path resolved(const fs::path& folder) {
    std::error_code failed;
    if (folder.empty()) fail("''", "is no name of a folder");
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
        fail(folder, "is a file; what is written here is a folder");
    check_ours(target);
    return target;
}

}  // namespace

void Staging::check(const fs::path& folder) { (void)resolved(folder); }

Staging::Staging(const fs::path& folder) : target_(resolved(folder)) {
    std::error_code failed;
    fs::create_directories(target_.parent_path(), failed);
    if (failed) fail(folder, fmt::format("cannot make its folder: {}", failed.message()));
    remove_abandoned(target_);
    const auto no_cleanup = no_cleanup_now();
    // Before this run locks the new folder, another run may remove it as abandoned: then it does
    // not exist, or is locked by the other run, and a new one is created.
    while (lock_ < 0) {
        std::string name = (target_.parent_path() / (staging_prefix(target_) + "XXXXXX")).string();
        if (::mkdtemp(name.data()) == nullptr)
            fail(folder, fmt::format("cannot be written: {}", std::strerror(errno)));
        staging_ = name;
        lock_ = lock_folder(staging_);
        struct stat entry {};
        // a file system without locks
        if (lock_ < 0 && errno != EWOULDBLOCK && errno != ENOENT) break;
        if (lock_ >= 0 && (::fstat(lock_, &entry) != 0 || entry.st_nlink == 0))
            ::close(std::exchange(lock_, -1));
    }
    cleanup_.emplace([staging = staging_](int) { remove_ours(staging); });
    fill(staging_ / marker, "");
    ::chmod(
        staging_.c_str(), 0777 & ~[] {
            const mode_t mask = ::umask(0);
            ::umask(mask);
            return mask;
        }());
}

Staging::~Staging() {
    if (lock_ >= 0) ::close(lock_);
    if (staging_.empty()) return;
    try {
        remove_ours(staging_);
    } catch (const std::exception&) {  // an unreadable folder is left beside the new one
    }
}

void Staging::publish() {
    std::string list = fmt::format("{}\n", manifest_head);
    for (const auto& file : files_in(staging_))
        if (file != marker) list += line_of(staging_, file) + "\n";
    fill(staging_ / manifest, list);
    fs::remove(staging_ / marker);
    for (const auto& entry : fs::recursive_directory_iterator(staging_))
        if (entry.is_directory()) flush_folder(entry.path());
    flush_folder(staging_);
    if (::renameat2(AT_FDCWD, staging_.c_str(), AT_FDCWD, target_.c_str(), RENAME_NOREPLACE) == 0) {
        staging_.clear();
    } else if (errno == EEXIST) {
        check_ours(target_);  // repeated: a file may have been added meanwhile
        if (::renameat2(AT_FDCWD, staging_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) !=
            0)
            fail(target_,
                 fmt::format("cannot be replaced in one step ({}); remove it or choose another "
                             "folder",
                             std::strerror(errno)));
    } else {
        fail(target_, fmt::format("cannot be written: {}", std::strerror(errno)));
    }
    flush_folder(target_.parent_path());
}

void write_folder(const fs::path& folder, const std::vector<NamedContent>& files) {
    Staging staging(folder);
    for (const auto& [name, content] : files) fill(staging.path() / name, content);
    staging.publish();
}

}  // namespace elastocheck::reports
