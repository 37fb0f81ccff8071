// One function a kind: a visit that forgets a kind does not compile.
#pragma once

namespace elastocheck {

template <class... F>
struct overloaded : F... {
    using F::operator()...;
};
template <class... F>
overloaded(F...) -> overloaded<F...>;  // clang 14 does not deduce it

}  // namespace elastocheck
