// Memory alignment for reproducible results of BLAS, whatever the number of threads.
#pragma once

namespace elastocheck::compare {

// Lets SuiteSparse allocate at multiples of 64 bytes. BLAS (ATLAS) selects its kernels, which round
// differently, by the alignment of the memory, and the address that malloc returns depends on what
// other threads allocate. It acts once, for the whole process; no other thread may be inside
// SuiteSparse at the first call.
void align_suitesparse();

}  // namespace elastocheck::compare
