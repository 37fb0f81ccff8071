// Visitor from one lambda per variant alternative: a missing alternative does not compile.
#pragma once

namespace elastocheck::reference::equilibrium {

template <class... F>
struct overloaded : F... {
    using F::operator()...;
};
template <class... F>
overloaded(F...) -> overloaded<F...>;  // clang 14 does not deduce it

}  // namespace elastocheck::reference::equilibrium
