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

#include "reports/document/provenance.hpp"

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

// In a staging folder until it is published: whatever is in there, this program put there.
constexpr const char* marker = ".elastocheck-staging";

std::string line_of(const fs::path& folder, const std::string& file) {
    return fmt::format("{}  {}", input_hash(read_whole(folder / file)), file);
}

// The lines of a manifest of ours; none where there is another file of that name.
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
    return fs::is_regular_file(fs::symlink_status(folder / file)) && listed.contains(line_of(folder, file));
}

// Everything in the folder must be on its manifest, as it was written.
void check_all_ours(const fs::path& folder) {
    const auto files = files_in(folder);
    const auto listed = listed_in(folder);
    for (const auto& file : files) {
        if (is_ours(folder, file, listed) || (file == manifest && !listed.empty())) continue;
        const bool changed =
            std::ranges::any_of(listed, [&](const auto& line) { return line.ends_with("  " + file); });
        fail(folder / file,
             changed
                 ? "was changed since elastocheck wrote it, and replacing the folder would lose that; choose "
                   "another folder, or remove this one"
                 : "is no part of a report, and replacing the folder would lose it; choose another folder");
    }
}

// What tells a folder from the one that is put in its place; nothing where there is none.
std::optional<std::pair<dev_t, ino_t>> identity(const fs::path& folder) {
    struct stat entry {};
    if (::stat(folder.c_str(), &entry) != 0) return std::nullopt;
    return std::pair{entry.st_dev, entry.st_ino};
}

// The same of a folder that another run may replace while it is looked at: what was seen then is of two, and is looked
// at again.
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

// Removes what check_ours would let pass, then the folders that are empty; the manifest last, so that a kill
// on the way leaves what can still be recognised.
void remove_ours(const fs::path& folder) {
    std::error_code ignored;
    if (fs::is_regular_file(fs::symlink_status(folder / marker))) {
        for (const auto& entry : fs::directory_iterator(folder, ignored))
            if (entry.path().filename() != marker) fs::remove_all(entry.path(), ignored);
        fs::remove(folder / marker, ignored);  // last: a kill on the way leaves what is still recognised
        ::rmdir(folder.c_str());
        return;
    }
    const auto listed = listed_in(folder);
    for (const auto& file : files_in(folder))
        if (file != manifest && is_ours(folder, file, listed)) fs::remove(folder / file, ignored);
    std::vector<fs::path> folders;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_directory() && !entry.is_symlink()) folders.push_back(entry.path());
    std::ranges::sort(folders, std::ranges::greater{}, [](const fs::path& f) { return f.native().size(); });
    for (const auto& inner : folders) ::rmdir(inner.c_str());
    if (!listed.empty() && files_in(folder).size() == 1) fs::remove(folder / manifest, ignored);
    ::rmdir(folder.c_str());  // fails where something is left
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

// What a run that was killed left beside the folder. Its owner held a lock on it while it lived.
void remove_abandoned(const fs::path& target) {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(target.parent_path(), ignored)) {
        if (!entry.path().filename().string().starts_with(staging_prefix(target)) || entry.is_symlink() ||
            !entry.is_directory())
            continue;
        const int lock = lock_folder(entry.path());
        if (lock < 0) continue;
        try {
            remove_ours(entry.path());
        } catch (const std::exception&) {  // somebody else's after all, or not to be read: it stays
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

// The folder itself, behind links, after the check that it may be replaced.
fs::path resolved(const fs::path& folder) {
    std::error_code failed;
    if (folder.empty()) fail("''", "is no name of a folder");
    fs::path target = fs::weakly_canonical(fs::absolute(folder), failed);
    if (failed) fail(folder, failed.message());
    if (!target.has_filename()) target = target.parent_path();
    if (!target.has_filename()) fail(folder, "is the root of a file system; choose a folder below it");
    const auto status = fs::status(target, failed);
    if (fs::is_symlink(fs::symlink_status(target, failed)) && status.type() == fs::file_type::not_found)
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
    // Another run may take it for one that was left, before it is locked; then it is gone, or locked by that one.
    while (lock_ < 0) {
        std::string name = (target_.parent_path() / (staging_prefix(target_) + "XXXXXX")).string();
        if (::mkdtemp(name.data()) == nullptr)
            fail(folder, fmt::format("cannot be written: {}", std::strerror(errno)));
        staging_ = name;
        lock_ = lock_folder(staging_);
        struct stat entry {};
        if (lock_ < 0 && errno != EWOULDBLOCK && errno != ENOENT) break;  // a file system without locks
        if (lock_ >= 0 && (::fstat(lock_, &entry) != 0 || entry.st_nlink == 0))
            ::close(std::exchange(lock_, -1));
    }
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
    } catch (const std::exception&) {  // what cannot be read is left beside the folder
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
        check_ours(target_);  // again: somebody may have put a file there meanwhile
        if (::renameat2(AT_FDCWD, staging_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) != 0)
            fail(target_, fmt::format("cannot be replaced in one step ({}); remove it or choose another "
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
