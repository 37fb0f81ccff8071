// What a computation is made with: how its sums are rounded, and whether what is denormal counts as zero. A library that is
// linked with, or whoever calls this one, may have set either; that must cost digits at most.
#pragma once

#include <cfenv>

namespace elastocheck::compare {

enum class Arithmetic {
    nearest,  // as it is everywhere
    up,
    down,
    towards_zero,
    flushed,  // to nearest; denormal operands and results are zero
};
const char* name(Arithmetic arithmetic);

// Whether this processor has it.
bool exists(Arithmetic arithmetic);

// In force in this thread while it lives. Pre: exists(arithmetic).
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
