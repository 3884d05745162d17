#include "cli/mpi/sample_queue.hpp"

#include <mpi.h>

#include <chrono>
#include <thread>

namespace isostat::cli {

namespace {

/// Messages to rank 0 carry one number; it answers an `ask` with a number or `none`.
enum Tag { ask = 1, answer = 2, is_done = 3, leave = 4 };
constexpr long none = -1;

} // namespace

MpiQueue::MpiQueue(std::size_t count) : count_(count) {
    MPI_Init(nullptr, nullptr);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks_);
}

MpiQueue::~MpiQueue() {
    MPI_Finalize();
}

std::optional<std::size_t> MpiQueue::next() {
    if (stopped_) {
        return std::nullopt;
    }
    if (rank_ == 0) {
        return take();
    }
    long number = none;
    MPI_Sendrecv(&none, 1, MPI_LONG, 0, ask, &number, 1, MPI_LONG, 0, answer, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return number == none ? std::nullopt : std::optional(static_cast<std::size_t>(number));
}

void MpiQueue::done(std::size_t number) {
    if (rank_ != 0) {
        const long text = static_cast<long>(number);
        MPI_Send(&text, 1, MPI_LONG, 0, is_done, MPI_COMM_WORLD);
    } else if (on_done) {
        on_done(number);
    }
}

void MpiQueue::idle() {
    if (rank_ != 0) {
        return;
    }
    for (;;) {
        int waiting = 0;
        MPI_Status status;
        MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &waiting, &status);
        if (waiting == 0) {
            return;
        }
        long number = none;
        MPI_Recv(&number, 1, MPI_LONG, status.MPI_SOURCE, status.MPI_TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        if (status.MPI_TAG == ask) {
            const auto taken = take();
            const long text = taken ? static_cast<long>(*taken) : none;
            MPI_Send(&text, 1, MPI_LONG, status.MPI_SOURCE, answer, MPI_COMM_WORLD);
        } else if (status.MPI_TAG == is_done && on_done) {
            on_done(static_cast<std::size_t>(number));
        } else if (status.MPI_TAG == leave) {
            ++leaving_;
        }
    }
}

void MpiQueue::stop() {
    stopped_ = true;
    count_ = next_;
}

void MpiQueue::finish() {
    if (rank_ != 0) {
        MPI_Send(&none, 1, MPI_LONG, 0, leave, MPI_COMM_WORLD);
        return;
    }
    constexpr auto pause = std::chrono::milliseconds(5);
    while (leaving_ < ranks_ - 1) {
        idle();
        std::this_thread::sleep_for(pause);
    }
}

} // namespace isostat::cli
