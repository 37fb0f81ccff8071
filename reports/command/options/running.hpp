// Options of a long computation: --jobs, --quiet. Neither changes a result, and the command line in
// a document leaves both out.
#pragma once

namespace elastocheck::reports {

struct Running {
    int jobs = 0;  // 0: one for each core
    bool quiet = false;
};

// The number of threads; switches the progress off if that is requested.
int threads_of(const Running& running);

}  // namespace elastocheck::reports
