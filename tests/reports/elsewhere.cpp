// Linked into the command, this makes elastocheck_elsewhere: the same program in another
// environment. The locale of the environment is active for C and C++, as in a program that calls
// the library, and the clock advances by a millisecond per call, so that two runs can be compared
// byte by byte.

#include <atomic>
#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <locale>

namespace {

std::atomic<long> looks = 0;

[[maybe_unused]] const bool in_force = [] {
    if (std::setlocale(LC_ALL, "") == nullptr) {
        std::fputs("the locale of the environment does not exist\n", stderr);
        std::_Exit(70);
    }
    std::locale::global(std::locale(""));
    return true;
}();

}  // namespace

extern "C" int clock_gettime(clockid_t, timespec* now) noexcept {
    const long ms = ++looks;
    now->tv_sec = ms / 1000;
    now->tv_nsec = ms % 1000 * 1'000'000;
    return 0;
}
