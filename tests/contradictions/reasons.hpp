#pragma once
// Why `verify` leaves a random run undecided: the table of README.md.

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

namespace contradictions {

/// Words of a message, and the row of the table.
struct Reason {
    std::string_view words, row;
};

inline constexpr std::array reasons{
    Reason{"the way is not proved", "level arcs: the way is not proved"},
    Reason{"as far as steps in double tell", "steps in double meet another pair first"},
    Reason{"was not found to", "steps in double do not find the end"},
    Reason{"no true vertex is proved", "a vertex is nearly singular"},
    Reason{"unless a coordinate held earlier was released", "a hold may have been released and turned back"},
};

/// Of a run by its first message, what others follow from. Empty: the table names none.
inline std::string reason_of(const std::string& message) {
    const auto row = std::find_if(reasons.begin(), reasons.end(), [&message](const Reason& reason) {
        return message.find(reason.words) != std::string::npos;
    });
    return row == reasons.end() ? std::string() : std::string(row->row);
}

} // namespace contradictions
