#include "checker/run_records.hpp"

#include "io/files.hpp"
#include "io/json.hpp"

#include <isostat/core/result.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace isostat::checker {

namespace {

using json::Field;

// exact: length of a name
constexpr std::array<std::string_view, 5> statuses{"running", "completed", "failed", "undecided", "interrupted"};

/// Complete lines with their numbers, from 1.
template <class Use> void for_each_line(const std::string& text, const Use& use) {
    int number = 1;
    for (std::size_t begin = 0; begin < text.size(); ++number) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        if (end > begin) {
            use(number, text.substr(begin, end - begin));
        }
        begin = end + 1;
    }
}

/// One of the words that a record may have in a field.
std::string word(const Field& field, const std::vector<std::string_view>& words) {
    if (std::find(words.begin(), words.end(), field.string()) == words.end()) {
        field.fail(fmt::format("one of {}", fmt::join(words, ", ")));
    }
    return field.string();
}

std::string contact_name(const Field& field, int dimension) {
    if (!contact_spelt(field.string(), dimension)) {
        field.fail("a contact as records spell it, 3-7, 3-left or held x of grain 4");
    }
    return field.string();
}

TieRecord tie_of(const Field& entry, int dimension) {
    entry.only({"decision", "contact", "first_order", "against", "against_first_order", "choice", "log2_zero", "bits"});
    const auto term = [](const Field& pair, double& value, double& bound) {
        pair.require_size(2, "[value, bound]");
        value = pair.at(std::size_t{0}).number();
        bound = pair.at(std::size_t{1}).number();
        if (bound < 0) {
            pair.fail("[value, bound], the bound from 0");
        }
    };
    TieRecord tie;
    tie.what = word(entry.at("decision"), {"force", "opening", "start", "limit", "zero all along", "gap", "step",
                                           "second order", "end", "rest"});
    tie.contact = contact_name(entry.at("contact"), dimension);
    term(entry.at("first_order"), tie.first, tie.first_bound);
    if (entry.has("against") || entry.has("against_first_order")) {
        tie.against = contact_name(entry.at("against"), dimension);
        term(entry.at("against_first_order"), tie.other, tie.other_bound);
    }
    if (entry.has("choice")) {
        tie.choice = word(entry.at("choice"), {"infinitesimal loads", "names", "zero", "watched"});
    }
    return tie;
}

/// Whether the run claims that the motion of an arc is proved, past all other contacts and with a positive power.
bool claims_way(const Field& certificate) {
    const auto proved = [&certificate](const char* name) {
        return word(certificate.at(name), {"proved", "refuted", "undecided"}) == "proved";
    };
    return proved("verdict") && proved("power");
}

EventRecord event_of(const std::string& line, const std::string& where, const Load& load) {
    const RecordColumns names = record_columns(load, load.loads_tilt());
    const json::Json parsed = Field::parse(line, where);
    const Field field(parsed, where);
    const std::string strain_bound = names.strain + "_bound";
    const auto [stress, strain, bound] = std::array{names.stress.c_str(), names.strain.c_str(), strain_bound.c_str()};
    field.only(event_names(names).all);
    const auto number = [&field](const char* name) {
        const Field value = field.at(name);
        return value.value().is_null() ? std::numeric_limits<double>::quiet_NaN() : value.number();
    };
    constexpr int most = std::numeric_limits<int>::max();
    EventRecord event;
    event.where = where;
    event.step = field.at("step").integer();
    event.equilibrium = field.at("equilibrium").integer(0, most);
    event.arc = field.at("arc").integer(0, most);
    event.kind = word(field.at("kind"), {"limit", "tension", "rattler", "release"});
    event.opened = contact_name(field.at("opened"), load.dimension);
    event.closed = contact_name(field.at("closed"), load.dimension);
    event.power_turn = field.at("power_turn").boolean();
    event.stress = number(stress);
    event.strain = number(strain);
    event.strain_bound = number(bound);
    event.force_bound = number("force_bound");
    event.power_bound = number("power_bound");
    event.work_bound = number("work_bound");
    event.force = number("force");
    event.power = number("power");
    event.work = number("work");
    event.displacement = number("displacement");
    if (field.has("held_at")) {
        event.held_at = field.at("held_at").number();
        if (!event.power_turn) {
            field.at("held_at").fail("no such field: the arc ends at no power turn");
        }
    }
    if (field.has("certificate")) {
        event.claims_way = claims_way(field.at("certificate"));
    }
    for (std::size_t k = 0; field.has("perturbed") && k < field.at("perturbed").size(); ++k) {
        event.ties.push_back(tie_of(field.at("perturbed").at(k), load.dimension));
    }
    return event;
}

/// The two columns of a contact must be in its one spelling, or in that of no contact.
void require_spelling(const EquilibriumLine& line, const std::string& what) {
    const int i = line.integer(what + "_i");
    const int j = line.integer(what + "_j");
    const bool none = j == no_contact && i >= no_contact;
    if (!none && (i < 0 || j < last_wall || (j >= 0 && j < i))) {
        throw Error(ErrorKind::bad_input,
                    fmt::format("{}: {}_i,{}_j is '{},{}': expected a disk and a later one or a wall, or -9,-9",
                                line.where, what, what, i, j));
    }
}

} // namespace

std::optional<StateFile> RunRecords::stored(int equilibrium) const {
    const std::filesystem::path path = states / fmt::format("eq_{:06}.json", equilibrium);
    if (!std::filesystem::exists(path)) {
        return {};
    }
    return read_any_state(path, Dimensions::any_clumps);
}

RunRecords read_records(const std::filesystem::path& directory, LastLine last) {
    RunRecords records;
    const std::string header = (directory / "run.json").string();
    const json::Json parsed = Field::parse(read_text(directory / "run.json"), header);
    const Field run(parsed, header);
    (void)word(run.at("format"), {"isostat-run"});
    (void)run.at("version").integer(1, 1);
    records.directory = directory;
    const std::string& status = run.at("status").string();
    records.status = status.substr(0, status.find(':'));
    if (std::find(statuses.begin(), statuses.end(), records.status) == statuses.end()) {
        run.at("status").fail(fmt::format("one of {}, with a reason behind a colon", fmt::join(statuses, ", ")));
    }
    records.reason = status.substr(std::min(status.size(), records.status.size() + 2));
    records.program = run.at("program").string();
    records.segments = static_cast<int>(run.at("programme").size());
    const Field settings = run.at("settings").at("run");
    records.rule = word(settings.at("rule"), opening_rules());
    if (settings.has("rule_seed")) {
        records.rule_seed = static_cast<std::uint64_t>(settings.at("rule_seed").integer());
    }
    if (settings.has("ties") && word(settings.at("ties"), {"stop", "choose"}) == "choose") {
        records.max_choices =
            settings.has("max_choices") ? settings.at("max_choices").number() : std::numeric_limits<double>::infinity();
        records.chooses = records.max_choices > 0;
    }
    const std::string level =
        settings.has("certify") ? word(settings.at("certify"), {"decisions", "states", "arcs"}) : "decisions";
    records.certified_arcs = level == "arcs";
    records.certified_states = level == "states" || records.certified_arcs;
    records.states = directory / "states";
    if (std::filesystem::exists(directory / "start.json")) {
        records.start = read_any_state(directory / "start.json", Dimensions::any_clumps).state;
    }
    // A run that never left its start has no events, and an empty file.
    const std::filesystem::path events = directory / "events.jsonl";
    if (!std::filesystem::exists(events) || std::filesystem::file_size(events) > 0) {
        long choices = 0;
        const std::optional<StateFile> first = records.start ? std::nullopt : records.stored(0);
        const Load load = records.start ? records.start->load : first ? first->state.load : Load();
        for_each_line(records_text(events, last), [&](int number, const std::string& line) {
            records.events.push_back(event_of(line, fmt::format("{}:{}", events.string(), number), load));
            EventRecord& event = records.events.back();
            choices += std::count_if(event.ties.begin(), event.ties.end(),
                                     [](const TieRecord& tie) { return !tie.choice.empty(); });
            event.choices = choices;
        });
    }
    const std::filesystem::path equilibria = directory / "equilibria.csv"; // its first row comes with their names
    if (!std::filesystem::exists(equilibria) || std::filesystem::file_size(equilibria) > 0) {
        records.equilibria = read_equilibrium_lines(equilibria, last);
        for (const EquilibriumLine& line : records.equilibria) {
            for (const char* contact : {"opens_low", "opens_high", "min_force", "min_gap"}) {
                require_spelling(line, contact);
            }
        }
    }
    return records;
}

} // namespace isostat::checker
