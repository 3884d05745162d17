#pragma once
// Why `verify` leaves a random run undecided: the table of README.md.

#include "support/test.hpp"

#include <string_view>

namespace contradictions {

/// Words of a message, and the row of the table.
struct Reason {
    std::string_view words, row;
};

inline constexpr std::array reasons{
    Reason{"the way is not proved", "level arcs: the way is not proved from its witness"},
    Reason{"as far as steps in double tell", "steps in double lose the curve: they meet another pair first"},
    Reason{"was not found to", "steps in double lose the curve: they do not find the end"},
    Reason{"steps in double ended where", "what steps in double contradict is not proved to be the end"},
    Reason{"no true vertex is proved", "the contacts are nearly singular"},
    Reason{"unless a coordinate held earlier was released", "a hold may have been released and turned back"},
    Reason{"which a coarser grid may have moved", "a hold is counted from a pinned disk that the grid moved"},
    Reason{"the sign of the", "a force is 0 as far as is seen, and may open"},
    Reason{"cannot be told from 0", "a force is 0 as far as is seen, and may open"},
    Reason{"cannot order", "two forces are not ordered"},
    Reason{"vanish together", "two forces are not ordered"},
    Reason{"certificates/", "a claim of a certificate is narrower than what the checker encloses"},
    Reason{"the stress is", "the stress of an arc is off by more than the bound in the row, by a rounding"},
    Reason{"claimed in", "the stress of an arc is off by more than the bound in the row, by a rounding"},
    Reason{"no stored state has the direction", "a run that chose ended before it stored a state"},
    Reason{"the potential does not decrease", "an arc of length 0, as far as is seen"},
    Reason{"which the run left at 0", "a load is 0: forces that the run left at 0 by choice vanish by counting"},
    Reason{"says too little", "a bound says nothing, and the number beside it is off"},
};

/// Of a run by its first message, what others follow from. Empty: the table names none.
inline std::string reason_of(const std::string& message) {
    const auto row = std::ranges::find_if(
        reasons, [&message](const Reason& reason) { return message.find(reason.words) != std::string::npos; });
    return row == reasons.end() ? std::string() : std::string(row->row);
}

} // namespace contradictions
