// Options of a long computation: --jobs, --quiet. Neither changes a result, and the command line in
// a document leaves both out.
#pragma once

#include "reports/command/grammar/command.hpp"

namespace elastocheck::reports {

struct Running {
    int jobs = 0;  // 0: one for each core
    bool quiet = false;
};
Option jobs_option(Running& running);   // --jobs
Option quiet_option(Running& running);  // --quiet

// The number of threads; switches the progress off if that is requested.
int threads_of(const Running& running);

}  // namespace elastocheck::reports
