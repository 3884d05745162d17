#pragma once
// Every field of every file that a run writes, altered one at a time, and what `verify` says of each. Whoever alters a
// file signs the folder again: the digests have no key.

#include "checker/run_records.hpp"
#include "support/forger.hpp"

namespace altered_run {

namespace fs = std::filesystem;
using isostat::json::Json;

/// The text of a file with one field altered.
struct Altered {
    std::string field; ///< with the numbers of entries left out: "load.stress[0]", "disks[][2]"
    std::string how, text;
};

/// So often each alteration of a field is tried, in the files of a kind.
class Budget {
  public:
    explicit Budget(int most) : most_(most) {}
    bool take(const std::string& field, const std::string& how) { return tried_[field + " " + how]++ < most_; }

  private:
    int most_;
    std::map<std::string, int> tried_;
};

/// What may stand in the place of a value; nothing: the field is left out.
inline std::vector<std::pair<std::string, std::optional<Json>>> others(const Json& value) {
    if (value.is_boolean()) {
        return {{"other", !value.get<bool>()}};
    }
    if (value.is_number_integer()) {
        return {{"more", value.get<long>() + 1}, {"less", value.get<long>() - 1}};
    }
    if (value.is_number()) {
        const double x = value.get<double>();
        const double step = x == 0 ? 1e-3 : 1e-3 * std::abs(x);
        const std::string at = x == 0 ? " at 0" : ""; // is tried beside other numbers of the field
        return {{"more" + at, x + step}, {"less" + at, x - step}, {"far" + at, -3 * x - 1e3}, {"huge" + at, 1e200}};
    }
    if (value.is_string()) {
        const auto text = value.get<std::string>();
        if (!isostat::checker::contact_spelt(text, isostat::plane)) {
            return {{"other", text + "x"}};
        }
        std::string spelt = text; // 1-2 as 2-1, 1-left as 01-left
        const std::size_t bar = text.find('-');
        const bool pair = bar != std::string::npos && text.find_first_not_of("0123456789-") == std::string::npos;
        spelt = pair ? text.substr(bar + 1) + "-" + text.substr(0, bar) : "0" + text;
        return {{"other", text == "0-1" ? "0-2" : "0-1"},
                {"wall", text == "0-left" ? "0-top" : "0-left"},
                {"spelt", spelt}};
    }
    return {{"number", Json(1.0)}};
}

/// Fields with a value, and lists and objects without one of theirs.
inline void walk(const Json& root, const Json::json_pointer& at, const std::string& field, Budget& budget,
                 std::vector<Altered>& list) {
    const Json& value = root.at(at);
    const auto add = [&](const std::string& where, const std::string& how, const std::function<void(Json&)>& change) {
        if (!budget.take(where, how)) {
            return;
        }
        Json copy = root;
        change(copy);
        list.push_back({where, how, copy.dump()});
    };
    if (value.is_object()) {
        for (const auto& [name, part] : value.items()) {
            if (name == "digest") {
                continue; // that is signed again
            }
            const std::string inner = field.empty() ? name : field + "." + name;
            add(inner, "left out", [&](Json& copy) { copy[at].erase(name); });
            walk(root, at / name, inner, budget, list);
        }
    } else if (value.is_array()) {
        const bool named = value.size() <= 3 && !std::all_of(value.begin(), value.end(),
                                                             [](const Json& part) { return part.is_structured(); });
        // A bar among the contacts says again what "bars" say: without the entry the file is read as before.
        const bool bar = !value.empty() && value.back().is_array() && !value.back().empty() && value.back()[0] == "bar";
        if (!value.empty() && !bar) {
            add(field, "shorter", [&](Json& copy) { copy[at].erase(value.size() - 1); });
        }
        for (std::size_t k = 0; k < value.size(); ++k) {
            walk(root, at / k, field + (named ? "[" + std::to_string(k) + "]" : "[]"), budget, list);
        }
    } else {
        for (const auto& [how, other] : others(value)) {
            add(field, how, [&](Json& copy) { copy[at] = *other; });
        }
    }
}

using scratch::joined, scratch::split;

/// Lines, one of them altered or left out or there twice. `of_line` gives its alterations.
template <class OfLine> std::vector<Altered> in_lines(const std::string& text, Budget& budget, const OfLine& of_line) {
    const std::vector<std::string> lines = split(text, '\n');
    std::vector<Altered> list;
    for (std::size_t k = 0; k < lines.size(); ++k) {
        for (Altered& one : of_line(k, lines[k])) {
            std::vector<std::string> changed = lines;
            changed[k] = one.text;
            list.push_back({one.field, one.how, joined(changed, '\n') + "\n"});
        }
        if (!budget.take("line", "")) {
            continue;
        }
        std::vector<std::string> changed = lines;
        changed.erase(changed.begin() + static_cast<std::ptrdiff_t>(k));
        list.push_back({"line", "left out", joined(changed, '\n') + (changed.empty() ? "" : "\n")});
        changed = lines;
        changed.insert(changed.begin() + static_cast<std::ptrdiff_t>(k), lines[k]);
        list.push_back({"line", "twice", joined(changed, '\n') + "\n"});
    }
    return list;
}

inline std::vector<Altered> of_object(const std::string& text, Budget& budget) {
    std::vector<Altered> list;
    walk(Json::parse(text), Json::json_pointer(), "", budget, list);
    return list;
}

/// A number of a row as it stands there.
inline std::vector<Altered> of_cell(const std::string& name, const std::string& text) {
    const bool finite = text.find("inf") == std::string::npos;
    std::vector<Altered> list{
        {name, "fraction", text + ".5"}, {name, "word", "x"}, {name, "unbounded", finite ? "inf" : "-" + text}};
    if (!finite) {
        list.push_back({name, "bounded", "1"});
        return list;
    }
    for (const auto& [how, other] : others(Json::parse(text))) {
        list.push_back({name, how, other->dump()});
    }
    return list;
}

/// Rows under the names of their columns.
inline std::vector<Altered> of_table(const std::string& text, Budget& budget) {
    const std::vector<std::string> names = split(text.substr(2, text.find('\n') - 2), ',');
    return in_lines(text, budget, [&](std::size_t line, const std::string& row) {
        std::vector<Altered> list;
        const std::vector<std::string> cells = line == 0 ? names : split(row, ',');
        for (std::size_t c = 0; c < names.size(); ++c) {
            const auto with = [&](std::string cell) {
                std::vector<std::string> changed = cells;
                changed[c] = std::move(cell);
                return (line == 0 ? "# " : "") + joined(changed, ',');
            };
            for (const Altered& one :
                 line == 0 ? std::vector<Altered>{{"", "renamed", names[c] + "x"}, {"", "twice", names[c == 0 ? 1 : 0]}}
                           : of_cell(names[c], cells[c])) {
                if (budget.take(names[c], one.how)) {
                    list.push_back({names[c], one.how, with(one.text)});
                }
            }
        }
        return list;
    });
}

/// The alterations of one file of a run.
inline std::vector<Altered> of_file(const std::string& name, const std::string& text, Budget& budget) {
    if (name.ends_with(".csv")) {
        return of_table(text, budget);
    }
    if (name.ends_with(".jsonl")) {
        return in_lines(text, budget, [&](std::size_t, const std::string& line) { return of_object(line, budget); });
    }
    return of_object(text, budget);
}

/// The checkpoint is signed as it is; with any other file it is brought to what the folder holds.
inline void write_signed(const fs::path& run, const std::string& name, const std::string& text) {
    if (name == "checkpoint.json") {
        Json object = Json::parse(text);
        const Json state = object.contains("state") ? object.at("state") : Json();
        object.erase("digest");
        object.erase("state");
        std::string body = object.dump();
        body.pop_back();
        body += isostat::before_state + state.dump();
        scratch::write(run / name, body + isostat::before_digest + '"' + isostat::sha256(body) + "\"}\n");
        return;
    }
    scratch::write(run / name, name.starts_with("certificates/eq_") ? forger::sealed_certificate(text) : text);
    forger::seal(run);
}

/// "states/eq_000012.json" as "states/*.json".
inline std::string kind_of(const std::string& name) {
    const std::size_t slash = name.find('/');
    return slash == std::string::npos || name.ends_with(".jsonl") ? name : name.substr(0, slash + 1) + "*.json";
}

/// How often alterations of a field were proved, and refused or left undecided.
struct Count {
    int proved = 0, not_proved = 0;
    std::string example; ///< of one that was proved
};

/// By kind of file and field.
using Counts = std::map<std::pair<std::string, std::string>, Count>;

/// Tries every alteration of a field in a file of each kind, at most `most` times each, and counts what is said.
inline int try_all(const fs::path& run, int most, Counts& counts) {
    std::vector<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(run)) {
        if (entry.is_regular_file() && entry.path().filename() != "lock") {
            names.push_back(fs::relative(entry.path(), run).string());
        }
    }
    std::ranges::sort(names);
    std::map<std::string, Budget> budgets;
    int all = 0;
    const std::string checkpoint = scratch::read(run / "checkpoint.json");
    for (const std::string& name : names) {
        const std::string original = scratch::read(run / name);
        const std::string kind = kind_of(name);
        for (const Altered& one : of_file(name, original, budgets.try_emplace(kind, most).first->second)) {
            if (one.text == original) {
                continue;
            }
            Count& count = counts[{kind, one.field}];
            BOOST_TEST_CONTEXT(name << " " << one.field << " " << one.how) {
                bool proved = false;
                try {
                    write_signed(run, name, one.text);
                    proved = isostat::verify_run(run).verdict == isostat::Verdict::proved;
                } catch (const isostat::Error& error) {
                    BOOST_TEST((error.kind() == isostat::ErrorKind::bad_input), error.what());
                }
                ++(proved ? count.proved : count.not_proved);
                count.example = proved ? one.how : count.example;
            }
            ++all;
        }
        scratch::write(run / name, original);
        scratch::write(run / "checkpoint.json", checkpoint);
    }
    return all;
}

} // namespace altered_run
