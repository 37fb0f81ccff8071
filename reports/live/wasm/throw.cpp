// Exceptions of the WebAssembly module. There is no exception runtime: a throw calls the page with its message, and the
// page's exception passes through all frames of the module, whose instance is then discarded.
#include <yaml-cpp/exceptions.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <string>
#include <typeinfo>

// From the page; it does not return. `kind`: 0 an error in the input, 1 a fault.
[[clang::import_module("page"), clang::import_name("thrown"), noreturn]] void thrown(
    const char* text, std::size_t size, int kind);

namespace {

[[noreturn]] void end_with(const std::string& message, int kind) {
    thrown(message.data(), message.size(), kind);
}

}  // namespace

namespace elastocheck::live {
std::string name_of_scene;  // for messages of the YAML parser, which has only the line
}

// The names and types of the Itanium C++ ABI.
extern "C" {

void* __cxa_allocate_exception(std::size_t size) noexcept { return std::calloc(1, size + 64); }
void __cxa_free_exception(void* object) noexcept { std::free(object); }

[[noreturn]] void __cxa_throw(void* object, std::type_info* type, void (*)(void*)) {
    // Every class thrown here derives from std::exception alone, so that the object begins with it.
    const auto& error = *static_cast<const std::exception*>(object);
    const std::string name = type->name();
    if (name.find("4YAML") != name.npos) {  // as parse_yaml() reports it
        const auto& yaml = static_cast<const YAML::Exception&>(error);
        end_with(elastocheck::live::name_of_scene + ":" +
                     std::to_string(std::max(yaml.mark.line, 0) + 1) +
                     ": invalid YAML: " + yaml.msg,
                 0);
    }
    const bool input =
        name.find("SceneError") != name.npos || name.find("invalid_argument") != name.npos;
    end_with(error.what(), input ? 0 : 1);
}

[[noreturn]] void __cxa_rethrow() { end_with("rethrown", 1); }
}
