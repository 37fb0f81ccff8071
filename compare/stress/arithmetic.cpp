#include "compare/stress/arithmetic.hpp"

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace elastocheck::compare {
namespace {

#ifdef __SSE2__
constexpr bool can_flush = true;
void flush() {
    constexpr unsigned denormal_operands = 0x0040, denormal_results = 0x8000;  // of MXCSR: DAZ, FTZ
    _mm_setcsr(_mm_getcsr() | denormal_operands | denormal_results);
}
#else
constexpr bool can_flush = false;
void flush() {}
#endif

}  // namespace

const char* name(Arithmetic arithmetic) {
    switch (arithmetic) {
        case Arithmetic::nearest: return "rounded to nearest";
        case Arithmetic::up: return "rounded up";
        case Arithmetic::down: return "rounded down";
        case Arithmetic::towards_zero: return "rounded to zero";
        case Arithmetic::flushed: return "denormals are zero";
    }
    return "";
}

bool exists(Arithmetic arithmetic) { return arithmetic != Arithmetic::flushed || can_flush; }

WithArithmetic::WithArithmetic(Arithmetic arithmetic) {
    std::fegetenv(&before_);
    switch (arithmetic) {
        case Arithmetic::nearest: break;
        case Arithmetic::up: std::fesetround(FE_UPWARD); break;
        case Arithmetic::down: std::fesetround(FE_DOWNWARD); break;
        case Arithmetic::towards_zero: std::fesetround(FE_TOWARDZERO); break;
        case Arithmetic::flushed: flush(); break;
    }
}

WithArithmetic::~WithArithmetic() { std::fesetenv(&before_); }

}  // namespace elastocheck::compare
