// A visitor from one lambda a kind. A kind without a lambda does not compile.
#pragma once

namespace elastocheck::recursive {

template <class... F>
struct overloaded : F... {
    using F::operator()...;
};
template <class... F>
overloaded(F...) -> overloaded<F...>;  // clang 14 does not deduce it

}  // namespace elastocheck::recursive
