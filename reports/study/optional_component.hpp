// Modules that are loaded when they are needed, beside the program or where it is installed.
#pragma once

#include <dlfcn.h>
#include <fmt/format.h>

#include <stdexcept>
#include <string>

namespace elastocheck::reports {

// What `symbol` of the module returns. Throws std::invalid_argument "WHAT (the reason); HOW TO GET
// IT" without it. Never closed: its functions are used until the program ends.
template <class Functions>
const Functions& optional_component(const char* module, const char* symbol, const std::string& what,
                                    const std::string& how) {
    void* const handle = ::dlopen(module, RTLD_NOW | RTLD_LOCAL);
    void* const address = handle != nullptr ? ::dlsym(handle, symbol) : nullptr;
    if (address == nullptr)
        throw std::invalid_argument(fmt::format("{} ({}); {}", what, ::dlerror(), how));
    return *reinterpret_cast<const Functions* (*)()>(address)();
}

}  // namespace elastocheck::reports
