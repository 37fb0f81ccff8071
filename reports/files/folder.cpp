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
#include <fstream>
#include <set>

namespace elastocheck::reports {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& why) {
    throw FileError(fmt::format("{}: {}", path.string(), why));
}

std::vector<std::string> files_in(const fs::path& folder) {
    std::vector<std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (!entry.is_directory() || entry.is_symlink())
            files.push_back(entry.path().lexically_relative(folder).generic_string());
    std::ranges::sort(files);
    return files;
}

// What `compare -o`, `converge -o` and `trade -o` leave in a folder, told by the document among it.
bool holds_result(const fs::path& folder) {
    std::string start(200, '\0');
    std::ifstream in(folder / "result.json", std::ios::binary);
    in.read(start.data(), static_cast<std::streamsize>(start.size()));
    return start.find("\"elastocheck/result/") != start.npos;
}

// Everything in the folder must be on its list.
void check_ours(const fs::path& folder) {
    std::set<std::string> listed{manifest};
    if (holds_result(folder))
        listed.insert({"result.json", "curves.csv", "convergence.csv", "attribution.csv", "trade.csv",
                       "precision.csv"});
    std::ifstream in(folder / manifest);
    for (std::string line; std::getline(in, line);) listed.insert(line);
    for (const auto& file : files_in(folder))
        if (!listed.contains(file))
            fail(folder / file,
                 "is no part of a report, and replacing the folder would lose it; choose another folder");
}

std::string staging_prefix(const fs::path& target) {
    return fmt::format(".{}.elastocheck-", target.filename().string());
}

int lock_folder(const fs::path& folder) {
    const int lock = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock >= 0 && ::flock(lock, LOCK_EX | LOCK_NB) != 0) {
        ::close(lock);
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
        fs::remove_all(entry.path(), ignored);
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
    fs::path target = fs::weakly_canonical(fs::absolute(folder), failed);
    if (failed) fail(folder, failed.message());
    if (!target.has_filename()) target = target.parent_path();
    if (!target.has_filename()) fail(folder, "is the root of a file system; choose a folder below it");
    if (fs::exists(target)) {
        if (!fs::is_directory(target)) fail(folder, "is a file; a report is a folder");
        check_ours(target);
    }
    return target;
}

}  // namespace

void Staging::check(const fs::path& folder) { (void)resolved(folder); }

Staging::Staging(const fs::path& folder) : target_(resolved(folder)) {
    std::error_code failed;
    fs::create_directories(target_.parent_path(), failed);
    if (failed) fail(folder, fmt::format("cannot make its folder: {}", failed.message()));
    remove_abandoned(target_);
    std::string name = (target_.parent_path() / (staging_prefix(target_) + "XXXXXX")).string();
    if (::mkdtemp(name.data()) == nullptr)
        fail(folder, fmt::format("cannot be written: {}", std::strerror(errno)));
    staging_ = name;
    lock_ = lock_folder(staging_);
    ::chmod(
        staging_.c_str(), 0777 & ~[] {
            const mode_t mask = ::umask(0);
            ::umask(mask);
            return mask;
        }());
}

Staging::~Staging() {
    std::error_code ignored;
    if (!staging_.empty()) fs::remove_all(staging_, ignored);
    if (lock_ >= 0) ::close(lock_);
}

void Staging::publish() {
    std::string list;
    for (const auto& file : files_in(staging_)) list += file + "\n";
    write_whole(staging_ / manifest, list);
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

}  // namespace elastocheck::reports
