#pragma once
// Files that something went wrong with: what editors, other programs, disks and adversaries do to text.

#include "oracle/random.hpp"
#include "support/scratch.hpp"

namespace fuzz {

using isostat::oracle::Random;

inline std::string any_of(const std::vector<std::string>& list, Random& random) {
    return list[static_cast<std::size_t>(random.integer(static_cast<int>(list.size())))];
}

/// Words that readers fear.
inline std::string feared_word(Random& random) {
    static const std::vector<std::string> words = [] {
        std::vector<std::string> list =
            scratch::split("nan inf -inf -1 0 -0 -0.0 1e400 -1e400 1e-400 1e18 1e308 5e-324 1e200 1e-200 0.5D0 1,5 "
                           "0x1p-3 0x1p5000 + - +-1 . 1. .5 1_0 \" ' { ] [[ , # ITEM: \xff\xfe \xEF\xBB\xBF null true "
                           "\\ \\u0000 \\u001b[2J \x1b]0;owned\a \xC3 99999999999999999999 18446744073709551615 "
                           "9223372036854775808");
        list.insert(list.end(), {"\n", "\t", "`touch TRACE`", std::string(400, '7'), std::string(1, '\0')});
        return list;
    }();
    return any_of(words, random);
}

/// Where the `which`-th line begins and ends (its end of line included). \pre text not empty
struct LineAt {
    std::size_t begin = 0, size = 0;
};
inline LineAt some_line(const std::string& text, Random& random) {
    const auto at = static_cast<std::size_t>(random.integer(static_cast<int>(text.size())));
    const std::size_t before = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
    const std::size_t begin = before == std::string::npos ? 0 : before + 1;
    const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
    return {begin, end - begin};
}

/// A number, or a word between blanks and punctuation, replaced.
inline void replace_word(std::string& text, Random& random) {
    constexpr const char* ends = " \t,:[]{}=\"\n";
    const std::size_t at =
        text.find_first_not_of(ends, static_cast<std::size_t>(random.integer(static_cast<int>(text.size()))));
    if (at != std::string::npos) {
        text.replace(at, std::min(text.find_first_of(ends, at), text.size()) - at, feared_word(random));
    }
}

/// "name": value or name = value, with the next one's value, written a second time in front.
inline void double_key(std::string& text, Random& random) {
    const std::size_t mark =
        text.find_first_of(":=", static_cast<std::size_t>(random.integer(static_cast<int>(text.size()))));
    if (mark == std::string::npos || mark == 0) {
        return;
    }
    const std::size_t before = text.find_last_of("{,\n", mark - 1);
    const std::size_t begin = before == std::string::npos ? 0 : before + 1;
    const std::size_t end = std::min(text.find_first_of(",}\n", mark), text.size());
    const std::string pair = text.substr(begin, end - begin);
    text.insert(begin, pair + (text[mark] == ':' ? "," : "\n"));
}

inline void replace_all(std::string& text, const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
        text.replace(at, from.size(), to);
    }
}

/// A number in another spelling, or the next one: what an index, a counter or a column may not be.
inline void respell_number(std::string& text, Random& random) {
    const std::size_t at =
        text.find_first_of("0123456789", static_cast<std::size_t>(random.integer(static_cast<int>(text.size()))));
    if (at == std::string::npos) {
        return;
    }
    const std::size_t size = std::min(text.find_first_not_of("0123456789", at), text.size()) - at;
    const std::string digits = text.substr(at, size);
    std::string next = digits;
    next.back() = next.back() == '9' ? '0' : static_cast<char>(next.back() + 1);
    text.replace(at, size,
                 any_of({"+" + digits, "0" + digits, "-" + digits, digits + ".0", digits + ".9", digits + "e0",
                         digits + "e99", next},
                        random));
}

/// "3-7" to "7-3", "[3,7" to "[7,3".
inline void turn_pair(std::string& text, Random& random) {
    const auto is_digit = [&](std::size_t k) { return k < text.size() && text[k] >= '0' && text[k] <= '9'; };
    const std::size_t mark =
        text.find_first_of("-,", static_cast<std::size_t>(random.integer(static_cast<int>(text.size()))));
    if (mark == std::string::npos || mark == 0 || !is_digit(mark - 1) || !is_digit(mark + 1)) {
        return;
    }
    std::size_t begin = mark, end = mark + 1;
    for (; begin > 0 && is_digit(begin - 1); --begin) {
    }
    for (; is_digit(end); ++end) {
    }
    const std::string turned = text.substr(mark + 1, end - mark - 1) + text[mark] + text.substr(begin, mark - begin);
    text.replace(begin, end - begin, turned);
}

/// A word of the file in the place of another: of an enumeration, a key, a contact, a name.
inline void exchange_words(std::string& text, Random& random) {
    constexpr const char* ends = " \t,:[]{}=\"\n";
    const auto place = [&] {
        const std::size_t at =
            text.find_first_not_of(ends, static_cast<std::size_t>(random.integer(static_cast<int>(text.size()))));
        return at == std::string::npos ? LineAt{}
                                       : LineAt{at, std::min(text.find_first_of(ends, at), text.size()) - at};
    };
    const LineAt from = place(), to = place();
    text.replace(to.begin, to.size, text.substr(from.begin, from.size));
}

/// A column of a table once more, in front: its name too.
inline void double_column(std::string& text, Random& random) {
    const LineAt line = some_line(text, random);
    const auto columns = std::count(text.begin() + static_cast<std::ptrdiff_t>(line.begin),
                                    text.begin() + static_cast<std::ptrdiff_t>(line.begin + line.size), ',');
    const int which = random.integer(static_cast<int>(columns) + 1);
    std::string doubled;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        std::size_t at = begin;
        for (int k = 0; k < which && at < end; ++k) {
            at = std::min(text.find(',', at), end - 1) + 1;
        }
        std::string field = text.substr(at, std::min(text.find(',', at), end) - at);
        const std::size_t name = field.starts_with("# ") ? 2 : 0;
        const std::size_t mark = text.compare(begin, 2, "# ") == 0 ? 2 : 0;
        doubled +=
            text.substr(begin, mark) + field.substr(name) + "," + text.substr(begin + mark, end + 1 - begin - mark);
        begin = end + 1;
    }
    text = doubled;
}

/// Nesting without end, of both kinds.
inline std::string deep(Random& random) {
    const int depth = 1 << random.integer(17);
    switch (random.integer(4)) {
    case 0: return std::string(static_cast<std::size_t>(depth), '[');
    case 1: {
        std::string text;
        for (int k = 0; k < depth; ++k) {
            text += "{\"a\":";
        }
        return text;
    }
    case 2:
        return std::string(static_cast<std::size_t>(depth), '[') + std::string(static_cast<std::size_t>(depth), ']');
    default: {
        std::string text = "a";
        for (int k = 0; k < depth; ++k) {
            text += any_of({".a", ". a", ".\"b.\"", ".'c'"}, random);
        }
        return text + " = 1\n";
    }
    }
}

/// One to four changes.
inline std::string mutated(std::string text, Random& random) {
    for (int changes = 1 + random.integer(4); changes > 0 && !text.empty(); --changes) {
        const auto size = static_cast<int>(text.size());
        const auto at = static_cast<std::size_t>(random.integer(size));
        const auto length = static_cast<std::size_t>(1 + random.integer(std::min(size, 40)));
        switch (random.integer(21)) {
        case 0: text[at] = static_cast<char>(random.integer(256)); break;
        case 1: text[at] = static_cast<char>(text[at] ^ (1 << random.integer(8))); break;
        case 2: text.erase(at, length); break;
        case 3: text.insert(at, text.substr(static_cast<std::size_t>(random.integer(size)), length)); break;
        case 4: text.insert(at, feared_word(random)); break;
        case 5: text.resize(at); break;
        case 6: {
            const std::size_t digit = text.find_first_of("0123456789", at);
            if (digit != std::string::npos) {
                text[digit] = static_cast<char>('0' + random.integer(10));
            }
            break;
        }
        case 7: {
            const LineAt line = some_line(text, random);
            text.erase(line.begin, line.size);
            break;
        }
        case 8: {
            const LineAt line = some_line(text, random);
            text.insert(line.begin, text.substr(line.begin, line.size));
            break;
        }
        case 9: {
            const LineAt line = some_line(text, random);
            const std::string moved = text.substr(line.begin, line.size);
            text.erase(line.begin, line.size);
            text.insert(text.empty() ? 0 : some_line(text, random).begin, moved);
            break;
        }
        case 10: double_key(text, random); break;
        case 11: text.insert(0, "\xEF\xBB\xBF"); break;
        case 12: replace_all(text, "\n", any_of({"\r\n", "\r\n", "\r", "\n\n"}, random)); break;
        case 13:
            if (random.integer(8) == 0) { // long files: not often
                text.insert(some_line(text, random).begin, deep(random));
            }
            break;
        case 14: respell_number(text, random); break;
        case 15: turn_pair(text, random); break;
        case 16: exchange_words(text, random); break;
        case 17: double_column(text, random); break;
        default: replace_word(text, random); break;
        }
    }
    return text;
}

} // namespace fuzz
