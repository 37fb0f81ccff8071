// The module elastocheck-mpi.so: messages between ranks, by MPI.
#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

#include <type_traits>

#include "reports/study/ranks.hpp"

namespace {

using Message = elastocheck::reports::Ranks::Message;
static_assert(std::is_trivially_copyable_v<Message>);

constexpr int tag = 0;

// One thread at a time calls: in rank 0 that which serves, in the others that which asks.
void begin(int* rank, int* size) {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
    if (provided < MPI_THREAD_SERIALIZED) MPI_Abort(MPI_COMM_WORLD, 4);
    MPI_Comm_rank(MPI_COMM_WORLD, rank);
    MPI_Comm_size(MPI_COMM_WORLD, size);
}

// An error of MPI ends all ranks: that is the handler of MPI_COMM_WORLD.
void send(int to, const Message& message) {
    MPI_Send(&message, sizeof message, MPI_BYTE, to, tag, MPI_COMM_WORLD);
}

bool receive(int* from, Message* message) {
    int is_there = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, tag, MPI_COMM_WORLD, &is_there, &status);
    if (is_there == 0) return false;
    MPI_Recv(message, sizeof *message, MPI_BYTE, status.MPI_SOURCE, tag, MPI_COMM_WORLD, &status);
    *from = status.MPI_SOURCE;
    return true;
}

void end() { MPI_Finalize(); }

}  // namespace

extern "C" const elastocheck::reports::Ranks::Functions* elastocheck_mpi_functions() {
    static const elastocheck::reports::Ranks::Functions functions{begin, send, receive, end};
    return &functions;
}
