#pragma once
/// \file
/// Which candidates are contacts of the current structure: private to the room.

#include <isostat/contact/state.hpp>

#include <vector>

namespace isostat {

/// Flags of a sorted list of candidates, kept up to date from vertex to vertex: successive structures differ by a few
/// contacts, and the list is the same for many of them.
class KeptCandidates {
  public:
    /// One flag per candidate: 1 when the candidate is in `contacts`. Cost: two comparisons of lists, and a search per
    /// contact whose position changed since the last call. \pre `candidates` sorted. Valid until the next call.
    const std::vector<unsigned char>& of(const std::vector<Contact>& candidates, const std::vector<Contact>& contacts);

  private:
    void set(const Contact& contact, unsigned char flag);

    std::vector<Contact> candidates_;
    std::vector<Contact> contacts_;
    std::vector<unsigned char> kept_;
};

} // namespace isostat
