#include "compare/jobs/allocation.hpp"

#include <SuiteSparse_config.h>
#include <malloc.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <mutex>

namespace elastocheck::compare {
namespace {

void* aligned(std::size_t bytes) {
    constexpr std::size_t line = 64;
    if (bytes > SIZE_MAX - line) return nullptr;
    return std::aligned_alloc(line, std::max<std::size_t>(1, (bytes + line - 1) / line) * line);
}

void* aligned_and_zero(std::size_t count, std::size_t size) {
    if (size > 0 && count > SIZE_MAX / size) return nullptr;
    void* block = aligned(count * size);
    if (block != nullptr) std::memset(block, 0, count * size);
    return block;
}

void* aligned_again(void* old, std::size_t bytes) {
    void* block = aligned(bytes);
    if (block == nullptr || old == nullptr) return block;
    std::memcpy(block, old, std::min(bytes, ::malloc_usable_size(old)));
    std::free(old);
    return block;
}

}  // namespace

void align_suitesparse() {
    static std::once_flag once;
    std::call_once(once, [] {
        SuiteSparse_config.malloc_func = aligned;
        SuiteSparse_config.calloc_func = aligned_and_zero;
        SuiteSparse_config.realloc_func = aligned_again;  // free() suits all of them
    });
}

}  // namespace elastocheck::compare
