// Floating-point environment of a computation: rounding mode and flush-to-zero. A linked library or
// the calling program may have changed either one; that may cost digits, never correctness.
#pragma once

#include <cfenv>

namespace elastocheck::compare {

enum class Arithmetic {
    nearest,  // the default
    up,
    down,
    towards_zero,
    flushed,  // to nearest; denormal operands and results are zero (DAZ, FTZ)
};
const char* name(Arithmetic arithmetic);

// Whether this processor supports it.
bool exists(Arithmetic arithmetic);

// Sets the arithmetic of this thread for the lifetime of the object. Pre: exists(arithmetic).
class WithArithmetic {
  public:
    explicit WithArithmetic(Arithmetic arithmetic);
    ~WithArithmetic();
    WithArithmetic(const WithArithmetic&) = delete;
    WithArithmetic& operator=(const WithArithmetic&) = delete;

  private:
    std::fenv_t before_;
};

}  // namespace elastocheck::compare
