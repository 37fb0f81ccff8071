#include "reports/python/errors.hpp"

#include <pybind11/pybind11.h>

#include <filesystem>
#include <stdexcept>

#include "elastocheck/read_scene.hpp"
#include "reports/command/options/load_scene.hpp"
#include "reports/files/files.hpp"
#include "reports/json/json_cursor.hpp"

namespace elastocheck::python {
namespace {

void raise(const char* kind, const char* what) {
    const auto errors = pybind11::module_::import("elastocheck._errors");
    PyErr_SetString(errors.attr(kind).ptr(), what);
}

// The catch clauses have the order of those in main() of the command.
void translate(std::exception_ptr failure) {
    try {
        if (failure) std::rethrow_exception(failure);
    } catch (const SceneError& error) {
        raise("SceneError", error.what());
    } catch (const reports::NotTrimmed& error) {
        raise("NotTrimmed", error.what());
    } catch (const reports::FileError& error) {
        raise("FileError", error.what());
    } catch (const reports::ResultError& error) {
        raise("FileError", error.what());
    } catch (const reports::SheetError& error) {
        raise("SheetError", error.what());
    } catch (const std::filesystem::filesystem_error& error) {
        raise("FileError", error.what());
    } catch (const std::invalid_argument& error) {
        raise("ArgumentError", error.what());
    }
    // All else by pybind11: MemoryError, and RuntimeError for a bug.
}

}  // namespace

void translate_exceptions() { pybind11::register_exception_translator(&translate); }

}  // namespace elastocheck::python
