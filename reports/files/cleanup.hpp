// Cleanup when a signal ends the program: removes temporary files and folders, ends child
// processes.
#pragma once

#include <functional>
#include <list>
#include <mutex>

namespace elastocheck::reports {

// Installs handlers for SIGINT, SIGTERM, SIGHUP and SIGQUIT. They run the registered cleanups, the
// newest first, and then end the process by the default action: a shell reports 128 + the signal's
// number. A second signal ends the process immediately. A signal that was ignored stays ignored. To
// be called once, by main().
void clean_up_on_signals();

// A cleanup, registered for the lifetime of the object. `work` receives the signal and runs in a
// separate thread; other threads continue meanwhile.
class CleanupOnSignal {
  public:
    explicit CleanupOnSignal(std::function<void(int signal)> work);
    ~CleanupOnSignal();  // does not return after a signal, since the process is ending
    CleanupOnSignal(const CleanupOnSignal&) = delete;
    CleanupOnSignal& operator=(const CleanupOnSignal&) = delete;

  private:
    std::list<std::function<void(int)>>::iterator at_;
};

// Lock that excludes cleanups for its lifetime. It must be held while an object that needs a
// cleanup is created and registered, and while writing into a folder that a cleanup removes. Does
// not return after a signal.
[[nodiscard]] std::unique_lock<std::recursive_mutex> block_cleanup();

}  // namespace elastocheck::reports
