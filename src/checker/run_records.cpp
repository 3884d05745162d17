#include "checker/run_records.hpp"

#include "io/files.hpp"
#include "io/json.hpp"

#include <isostat/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace isostat::checker {

namespace {

using json::Field;

/// What the replay needs; further columns are left alone.
const std::vector<const char*> needed_columns{"number",
                                              "previous",
                                              "sigma2",
                                              "ratio",
                                              "eps1",
                                              "eps2",
                                              "L1",
                                              "L2",
                                              "arcs",
                                              "rattlers",
                                              "backbone",
                                              "dofs",
                                              "contacts",
                                              "rank",
                                              "h",
                                              "k",
                                              "held",
                                              "sigma2_low",
                                              "sigma2_high",
                                              "opens_low_i",
                                              "opens_low_j",
                                              "opens_high_i",
                                              "opens_high_j",
                                              "potential",
                                              "min_force",
                                              "min_force_i",
                                              "min_force_j",
                                              "min_gap",
                                              "min_gap_i",
                                              "min_gap_j",
                                              "proved",
                                              "certified",
                                              "solid_fraction",
                                              "force_bound",
                                              "eps1_bound",
                                              "eps2_bound",
                                              "L1_bound",
                                              "L2_bound",
                                              "sigma2_low_bound",
                                              "sigma2_high_bound",
                                              "potential_bound",
                                              "min_gap_bound"};

std::vector<std::string> split(std::string_view line, char separator) {
    std::vector<std::string> parts;
    for (std::size_t at = 0; at <= line.size();) {
        const std::size_t end = std::min(line.find(separator, at), line.size());
        parts.emplace_back(line.substr(at, end - at));
        at = end + 1;
    }
    return parts;
}

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

EventRecord event_of(const std::string& line, const std::string& where) {
    const json::Json parsed = Field::parse(line, where);
    const Field field(parsed, where);
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
    event.kind = field.at("kind").string();
    event.opened = field.at("opened").string();
    event.closed = field.at("closed").string();
    event.power_turn = field.at("power_turn").boolean();
    event.stress = number("sigma2");
    event.strain = number("eps2");
    event.strain_bound = number("eps2_bound");
    event.force_bound = number("force_bound");
    event.power_bound = number("power_bound");
    event.work_bound = number("work_bound");
    event.force = number("force");
    event.power = number("power");
    event.work = number("work");
    event.displacement = number("displacement");
    if (field.has("held_at")) {
        event.held_at = field.at("held_at").number();
    }
    if (field.has("perturbed")) {
        const Field list = field.at("perturbed");
        const auto term = [](const Field& pair, double& value, double& bound) {
            pair.require_size(2, "[value, bound]");
            value = pair.at(std::size_t{0}).number();
            bound = pair.at(std::size_t{1}).number();
        };
        for (std::size_t k = 0; k < list.size(); ++k) {
            const Field entry = list.at(k);
            TieRecord tie;
            tie.what = entry.at("decision").string();
            tie.contact = entry.at("contact").string();
            term(entry.at("first_order"), tie.first, tie.first_bound);
            if (entry.has("against")) {
                tie.against = entry.at("against").string();
                term(entry.at("against_first_order"), tie.other, tie.other_bound);
            }
            tie.choice = entry.has("choice") ? entry.at("choice").string() : "";
            event.ties.push_back(tie);
        }
    }
    return event;
}

double number_of(const std::string& text, const std::string& where, const std::string& name) {
    double value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || stop != text.data() + text.size() || std::isnan(value)) {
        throw Error(ErrorKind::bad_input, fmt::format("{}: {} is '{}': expected a number", where, name, text));
    }
    return value;
}

/// The text of a file of records, without a line that was cut.
std::string records_text(const std::filesystem::path& path, LastLine last) {
    std::string text = read_text(path);
    if (last == LastLine::may_be_cut) {
        text.resize(text.rfind('\n') + 1); // npos + 1: no line at all
    }
    return text;
}

std::vector<EquilibriumLine> equilibria_of(const std::filesystem::path& path, LastLine last) {
    std::vector<std::string> names;
    std::vector<EquilibriumLine> lines;
    for_each_line(records_text(path, last), [&](int number, const std::string& text) {
        const std::string where = fmt::format("{}:{}", path.string(), number);
        if (names.empty() && text.starts_with('#')) {
            names = split(text.substr(std::min(text.find_first_not_of("# "), text.size())), ',');
            for (const char* name : needed_columns) {
                if (std::find(names.begin(), names.end(), name) == names.end()) {
                    throw Error(ErrorKind::bad_input, fmt::format("{}: there is no column '{}'", where, name));
                }
            }
            return;
        }
        const std::vector<std::string> fields = split(text, ',');
        if (names.empty() || fields.size() != names.size()) {
            throw Error(ErrorKind::bad_input, fmt::format("{}: {} columns: expected {}, named by the first line", where,
                                                          fields.size(), names.size()));
        }
        EquilibriumLine& line = lines.emplace_back();
        line.where = where;
        for (std::size_t k = 0; k < names.size(); ++k) {
            line.value[names[k]] = number_of(fields[k], where, names[k]);
        }
    });
    return lines;
}

} // namespace

int EquilibriumLine::integer(const char* name) const {
    constexpr double largest = std::numeric_limits<int>::max();
    const double number = at(name);
    if (!(std::abs(number) <= largest) || number != std::trunc(number)) {
        throw Error(ErrorKind::bad_input, fmt::format("{}: {} is {}: expected an integer", where, name, number));
    }
    return static_cast<int>(number);
}

std::optional<StateFile<2>> RunRecords::stored(int equilibrium) const {
    const std::filesystem::path path = states / fmt::format("eq_{:06}.json", equilibrium);
    if (!std::filesystem::exists(path)) {
        return {};
    }
    return read_any_state<2>(path);
}

RunRecords read_records(const std::filesystem::path& directory, LastLine last) {
    RunRecords records;
    const std::string header = (directory / "run.json").string();
    const json::Json parsed = Field::parse(read_text(directory / "run.json"), header);
    const Field run(parsed, header);
    if (run.at("format").string() != "isostat-run") {
        run.at("format").fail("\"isostat-run\"");
    }
    records.directory = directory;
    const std::string& status = run.at("status").string();
    records.status = status.substr(0, status.find(':'));
    const Field settings = run.at("settings").at("run");
    records.rule = settings.at("rule").string();
    const std::string ties = settings.has("ties") ? settings.at("ties").string() : "stop";
    if (ties != "stop" && ties != "choose") {
        settings.at("ties").fail("\"stop\" or \"choose\"");
    }
    if (ties == "choose") {
        records.max_choices =
            settings.has("max_choices") ? settings.at("max_choices").number() : std::numeric_limits<double>::infinity();
        records.chooses = records.max_choices > 0;
    }
    const std::string level = settings.has("certify") ? settings.at("certify").string() : "decisions";
    if (level != "decisions" && level != "states" && level != "arcs") {
        settings.at("certify").fail("\"decisions\", \"states\" or \"arcs\"");
    }
    records.certified_arcs = level == "arcs";
    records.certified_states = level == "states" || records.certified_arcs;
    records.states = directory / "states";
    if (std::filesystem::exists(directory / "start.json")) {
        records.start = read_any_state<2>(directory / "start.json").state.packing.q;
    }
    // A run that never left its start has no events: the file is empty then.
    const std::filesystem::path events = directory / "events.jsonl";
    if (!std::filesystem::exists(events) || std::filesystem::file_size(events) > 0) {
        long choices = 0;
        for_each_line(records_text(events, last), [&](int number, const std::string& line) {
            records.events.push_back(event_of(line, fmt::format("{}:{}", events.string(), number)));
            EventRecord& event = records.events.back();
            choices += std::count_if(event.ties.begin(), event.ties.end(),
                                     [](const TieRecord& tie) { return !tie.choice.empty(); });
            event.choices = choices;
        });
    }
    const std::filesystem::path equilibria = directory / "equilibria.csv"; // its first row comes with their names
    if (!std::filesystem::exists(equilibria) || std::filesystem::file_size(equilibria) > 0) {
        records.equilibria = equilibria_of(equilibria, last);
    }
    return records;
}

namespace {

/// "(1,-2)" behind the name of a pair: periods along the axes that repeat.
std::optional<Image> image_named(std::string_view text, const Cell<2>& cell) {
    Image image;
    const char* at = text.data() + 1;
    const char* const end = text.data() + text.size() - 1;
    for (std::size_t a = 0; a < 2; ++a) {
        const auto [stop, error] = std::from_chars(at, end, image.m[a]);
        if (error != std::errc() || (a == 0 && (stop == end || *stop != ',')) || (a == 1 && stop != end) ||
            image.m[a] == std::numeric_limits<std::int8_t>::min() || (image.m[a] != 0 && !cell.periodic[a])) {
            return {};
        }
        at = stop + 1;
    }
    return image;
}

} // namespace

std::optional<Contact> contact_named(const std::string& name, const Packing<2>& packing) {
    if (name.starts_with("held ")) {
        const std::string_view rest = std::string_view(name).substr(5);
        const std::string_view middle = " of grain ";
        int grain = -1;
        if (rest.size() > middle.size() + 1 && rest.substr(1, middle.size()) == middle) {
            const std::string_view digits = rest.substr(1 + middle.size());
            const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), grain);
            if (error == std::errc() && stop == digits.data() + digits.size() && grain >= 0 &&
                2 * grain + (rest[0] == 'x' ? 0 : 1) < static_cast<int>(packing.q.size()) &&
                (rest[0] == 'x' || rest[0] == 'y')) {
                return Contact{ContactKind::held, 2 * grain + (rest[0] == 'x' ? 0 : 1), 0};
            }
        }
        return {};
    }
    const std::size_t bracket = std::min(name.find('('), name.size());
    Image image;
    if (bracket < name.size()) {
        const std::optional<Image> said = name.back() == ')' && packing.cell.any()
                                              ? image_named(std::string_view(name).substr(bracket), packing.cell)
                                              : std::nullopt;
        if (!said) {
            return {};
        }
        image = *said;
    }
    const std::vector<std::string> parts = split(std::string_view(name).substr(0, bracket), '-');
    const auto disk = [&packing](const std::string& text) {
        int value = -1;
        const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool good = error == std::errc() && stop == text.data() + text.size() && value < packing.disk_count();
        return good ? value : -1;
    };
    if (parts.size() != 2 || disk(parts[0]) < 0) {
        return {};
    }
    const int i = disk(parts[0]);
    if (!image.is_here() && disk(parts[1]) < 0) {
        return {};
    }
    if (parts[1] == "left" || parts[1] == "bottom") {
        return Contact{ContactKind::lower_wall, i, parts[1] == "left" ? 0 : 1};
    }
    if (parts[1] == "right" || parts[1] == "top") {
        return Contact{ContactKind::upper_wall, i, parts[1] == "right" ? 0 : 1};
    }
    const int j = disk(parts[1]);
    if (j < 0 || (i == j && image.is_here())) {
        return {};
    }
    return pair_of(i, j, image);
}

bool may_be(const Contact& columns, const Contact& pair) {
    return columns.kind == pair.kind && columns.i == pair.i && columns.j == pair.j;
}

std::optional<Contact> contact_of_columns(double i, double j, const Packing<2>& packing) {
    const auto disks = static_cast<double>(packing.disk_count());
    if (!(i >= 0 && i < disks) || !(j >= -4 && j < disks) || (i == j && !packing.cell.any())) {
        return {};
    }
    const int first = static_cast<int>(i);
    const int second = static_cast<int>(j);
    if (second >= 0) {
        return Contact{ContactKind::disk_disk, std::min(first, second), std::max(first, second)};
    }
    return second >= -2 ? Contact{ContactKind::lower_wall, first, -1 - second}
                        : Contact{ContactKind::upper_wall, first, -3 - second};
}

} // namespace isostat::checker
