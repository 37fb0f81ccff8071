#include "reports/files/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <utility>

namespace elastocheck::reports {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_access(const fs::path& file, const char* what, int error = errno) {
    throw FileError(fmt::format("{}: cannot be {}: {}", file.string(), what, std::strerror(error)));
}

std::string without_white_space(std::string_view text) {
    std::string solid;
    for (const char c : text)
        if (std::string_view(" \t\r\n").find(c) == std::string_view::npos) solid.push_back(c);
    return solid;
}

bool begins_as(const fs::path& file, const FileKind& kind) {
    std::string start(2 * kind.beginning.size() + 64, '\0');
    std::ifstream in(file, std::ios::binary);
    in.read(start.data(), static_cast<std::streamsize>(start.size()));
    start.resize(static_cast<std::size_t>(in.gcount()));
    return without_white_space(start).starts_with(without_white_space(kind.beginning));
}

const char* type_of(const struct stat& entry) {
    return S_ISLNK(entry.st_mode)    ? "a symbolic link"
           : S_ISDIR(entry.st_mode)  ? "a folder"
           : S_ISBLK(entry.st_mode)  ? "a block device"
           : S_ISCHR(entry.st_mode)  ? "a character device"
           : S_ISFIFO(entry.st_mode) ? "a pipe"
           : S_ISSOCK(entry.st_mode) ? "a socket"
                                     : "something";
}

[[noreturn]] void fail_type(const fs::path& file, const struct stat& entry) {
    throw FileError(
        fmt::format("{}: is {}; only regular files are written", file.string(), type_of(entry)));
}

void make_folder_of(const fs::path& file) {
    std::error_code failed;
    if (file.has_parent_path()) fs::create_directories(file.parent_path(), failed);
    if (failed)
        throw FileError(
            fmt::format("{}: cannot make its folder: {}", file.string(), failed.message()));
}

// False with errno set for an incomplete write.
bool write_all(int out, std::string_view content) {
    while (!content.empty()) {
        const ssize_t written = ::write(out, content.data(), content.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        content.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
}

// Flushes if `good`, and closes in any case; false with errno set on failure.
bool flush_and_close(int out, bool good) {
    good = good && (::fsync(out) == 0 || errno == EINVAL);
    const int error = errno;
    const bool closed = ::close(out) == 0;
    if (!good) errno = error;
    return good && closed;
}

bool write_and_close(int out, std::string_view content) {
    return flush_and_close(out, write_all(out, content));
}

}  // namespace

void check_may_write(const fs::path& file, const FileKind& kind) {
    struct stat entry {};
    if (::lstat(file.c_str(), &entry) != 0) {
        // A missing file or folder will be created; an inaccessible folder is an error now.
        if (errno != ENOENT) fail_access(file, "written");
        return;
    }
    if (!S_ISREG(entry.st_mode)) fail_type(file, entry);
    if (!begins_as(file, kind))
        throw FileError(
            fmt::format("{}: exists and was not written by elastocheck as {}; choose another name, "
                        "or remove it",
                        file.string(), kind.name));
}

namespace {

std::string temporary_prefix(const fs::path& path) {
    return fmt::format(".{}.elastocheck-", path.filename().string());
}

bool is_running(pid_t process) {
    return process != ::getpid() && (::kill(process, 0) == 0 || errno == EPERM);
}

}  // namespace

fs::path temporary_beside(const fs::path& path) {
    const std::string prefix = temporary_prefix(path);
    std::error_code failed;
    for (auto at =
             fs::directory_iterator(path.has_parent_path() ? path.parent_path() : ".", failed);
         !failed && at != fs::end(at); at.increment(failed)) {
        const std::string name = at->path().filename().string();
        if (!name.starts_with(prefix)) continue;
        pid_t process = 0;
        const char* const last = name.data() + name.size();
        const auto [end, error] = std::from_chars(name.data() + prefix.size(), last, process);
        std::error_code ignored;
        if (error == std::errc{} && end == last && !is_running(process))
            fs::remove_all(at->path(), ignored);
    }
    fs::path temporary = path;
    return temporary.replace_filename(fmt::format("{}{}", prefix, ::getpid()));
}

AtomicFile::AtomicFile(fs::path file, const FileKind& kind) : kind_(&kind), file_(std::move(file)) {
    make_folder_of(file_);
    check_may_write(file_, kind);
    temporary_ = temporary_beside(file_);
    out_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (out_ < 0) fail_access(file_, "written");
}

AtomicFile::~AtomicFile() {
    if (out_ >= 0) ::close(out_);
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::write_buffer() {
    if (!write_all(out_, buffer_)) fail_access(file_, "written");
    buffer_.clear();
}

void AtomicFile::add(std::string_view content) {
    constexpr std::size_t buffer_size = 1 << 16;
    buffer_ += content;
    if (buffer_.size() >= buffer_size) write_buffer();
}

void AtomicFile::finish() {
    write_buffer();
    if (!flush_and_close(std::exchange(out_, -1), true)) fail_access(file_, "written");
    check_may_write(file_, *kind_);  // again: a file may have appeared meanwhile
    if (::rename(temporary_.c_str(), file_.c_str()) != 0) fail_access(file_, "written");
    temporary_.clear();
}

void write_whole(const fs::path& file, std::string_view content, const FileKind& kind) {
    AtomicFile whole(file, kind);
    whole.add(content);
    whole.finish();
}

void append(const fs::path& file, std::string_view content) {
    const int out = ::open(file.c_str(), O_WRONLY | O_APPEND | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK);
    if (out < 0) fail_access(file, "appended to");
    struct stat entry {};
    if (::fstat(out, &entry) != 0 || !S_ISREG(entry.st_mode)) {
        ::close(out);
        fail_type(file, entry);
    }
    if (!write_and_close(out, content)) fail_access(file, "appended to");
}

void write_staged(const fs::path& file, std::string_view content) {
    make_folder_of(file);
    const int out =
        ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (out < 0 || !write_and_close(out, content)) fail_access(file, "written");
}

fs::path beside_program(std::initializer_list<std::string> places) {
    std::error_code failed;
    for (fs::path file = fs::read_symlink("/proc/self/exe", failed), folder = file.parent_path();
         !failed && folder != file; file = folder, folder = folder.parent_path())
        for (const std::string& place : places)
            if (std::error_code unseen; fs::exists(folder / place, unseen)) return folder / place;
    return {};
}

std::string read_whole(const fs::path& file, std::size_t largest) {
    const int in = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat entry {};
    if (in < 0 || ::fstat(in, &entry) != 0) fail_access(file, "read");
    std::string text;
    bool good = S_ISREG(entry.st_mode) || S_ISFIFO(entry.st_mode);
    if (!good) {
        ::close(in);
        throw FileError(fmt::format("{}: cannot be read: it is {}", file.string(), type_of(entry)));
    }
    for (char buffer[1 << 16]; good;) {
        const ssize_t count = ::read(in, buffer, sizeof buffer);
        if (count == 0) break;
        if (count < 0 && errno == EINTR) continue;
        good = count > 0;
        if (good) text.append(buffer, static_cast<std::size_t>(count));
        if (text.size() <= largest) continue;
        ::close(in);
        throw FileError(
            fmt::format("{}: cannot be read: it is larger than {} MiB; no file of its kind is",
                        file.string(), largest >> 20U));
    }
    const int error = errno;
    ::close(in);
    if (!good) fail_access(file, "read", error);
    return text;
}

}  // namespace elastocheck::reports
