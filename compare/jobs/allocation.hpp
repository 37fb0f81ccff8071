// Memory in which BLAS rounds alike whatever the threads do.
#pragma once

namespace elastocheck::compare {

// Lets SuiteSparse allocate at multiples of 64 bytes. BLAS (ATLAS) takes other kernels, which round
// otherwise, for memory at other multiples of 16 bytes, and on which of these malloc places a block
// depends on what other threads allocate. May be called at any time, by any thread.
void align_suitesparse();

}  // namespace elastocheck::compare
