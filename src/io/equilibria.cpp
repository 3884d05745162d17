// equilibria.csv, both ways: one table of its columns.
#include "io/equilibria.hpp"

#include "core/refuse.hpp"
#include "io/files.hpp"
#include "io/lines.hpp"
#include "io/numbers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <type_traits>

namespace isostat {

namespace {

/// What a row is made of.
struct Row {
    const EquilibriumRecord& record;
    double solid_fraction = 0;
    int previous = 0;
    RecordColumns names;
    MoreColumns more;
};

/// Calls `use(measure)` for the first ones, one for each axis, or for those of tilts.
template <class Use> void for_each_measure(const Row& row, bool tilts, const Use& use) {
    const auto axes = static_cast<std::size_t>(row.more.dimension);
    const auto& all = row.names.measures;
    for (std::size_t k = tilts ? axes : 0; k < (tilts ? all.size() : axes); ++k) {
        use(all[k]);
    }
}

/// The last columns: bounds, and what only some rows have.
template <class Use> void for_each_bound(const Row& row, const Use& use) {
    using Measure = RecordColumns::Measure;
    const EquilibriumRecord& r = row.record;
    for_each_measure(row, false, [&](const Measure& m) { use(m.strain + "_bound", r.strain_bound[m.axis]); });
    for_each_measure(row, false, [&](const Measure& m) { use(m.length + "_bound", r.length_bound[m.axis]); });
    use(row.names.stress + "_low_bound", r.stress_low_bound);
    use(row.names.stress + "_high_bound", r.stress_high_bound);
    use("potential_bound", r.potential_bound);
    use("min_gap_bound", r.min_gap_bound);
    for_each_measure(row, true, [&](const Measure& m) {
        use(m.strain, r.strain[m.axis]);
        use(m.length, r.length[m.axis]);
        use(m.strain + "_bound", r.strain_bound[m.axis]);
        use(m.length + "_bound", r.length_bound[m.axis]);
    });
    if (row.more.touching) {
        use("touching", r.touching.value());
    }
}

/// The one list of columns, in their order but for the time, which is last. `use` takes the name and the value, an
/// integer or a double.
template <class Use> void for_each_column(const Row& row, const Use& use) {
    const EquilibriumRecord& r = row.record;
    using Measure = RecordColumns::Measure;
    const auto contact = [&use](const std::string& name, const Contact& value) {
        const auto [i, j] = contact_columns(value);
        use(name + "_i", i);
        use(name + "_j", j);
    };
    use("number", r.number);
    use("previous", row.previous);
    use("segment", r.segment);
    use(row.names.stress, r.stress);
    use("ratio", r.stress / r.sigma1);
    if (row.names.of_path) {
        use("p", r.mean_stress);
        use("q", r.deviator);
    }
    for_each_measure(row, false, [&](const Measure& m) { use(m.strain, r.strain[m.axis]); });
    for_each_measure(row, false, [&](const Measure& m) { use(m.length, r.length[m.axis]); });
    use("solid_fraction", row.solid_fraction);
    use("arcs", r.arcs);
    use("rattlers", r.rattlers);
    use("backbone", r.backbone);
    use("dofs", r.dof_count);
    use("contacts", r.contact_count);
    use("rank", r.rank);
    use("h", r.hyperstaticity);
    use("k", r.mechanisms);
    use("held", r.held);
    use(row.names.stress + "_low", r.stress_low);
    use(row.names.stress + "_high", r.stress_high);
    contact("opens_low", r.opens_low);
    contact("opens_high", r.opens_high);
    use("potential", r.potential);
    use("min_force", r.min_force);
    contact("min_force", r.min_force_contact);
    use("min_gap", r.min_gap);
    contact("min_gap", r.min_gap_contact);
    use("force_bound", r.force_bound);
    use("sigma_min_bound", r.sigma_min_bound);
    use("balance", r.balance);
    use("virtual_power", r.virtual_power);
    use("gap_residual", r.gap_residual);
    use("margin", r.margin);
    use("decided_by", static_cast<int>(r.decided_by));
    use("proved", r.verdict == Verdict::proved ? 1 : 0);
    use("certified", !r.certified ? -1 : *r.certified == Verdict::proved ? 1 : 0);
    for_each_bound(row, use);
}

/// The names, and whether integers are there.
template <class Use> void for_each_name(MoreColumns more, const Use& use) {
    EquilibriumRecord any;
    any.strain = any.strain_bound = any.length = any.length_bound = std::vector<double>(most_axes + most_tilts);
    any.touching = 0;
    for_each_column({any, 0, 0, record_columns(more), more},
                    [&use](const std::string& name, auto value) { use(name, std::is_integral_v<decltype(value)>); });
}

[[noreturn]] void bad_field(const std::string& where, const std::string& name, std::string_view text,
                            const std::string& expected) {
    refuse(where, "{} is '{}': expected {}", name, text, expected);
}

double number_of(std::string_view text, const std::string& where, const std::string& name) {
    if (integer_columns().contains(name)) {
        const auto integer = plain_integer(text);
        if (!integer || *integer != static_cast<int>(*integer)) {
            bad_field(where, name, text, "an integer");
        }
        return static_cast<int>(*integer);
    }
    const auto number = text == "inf" ? HUGE_VAL : text == "-inf" ? -HUGE_VAL : finite_number(text);
    if (!number) {
        bad_field(where, name, text, "a number");
    }
    return *number;
}

/// A line as the reports need it.
class Fields {
  public:
    explicit Fields(const EquilibriumLine& line) : line_(line) {}
    /// Beyond 1e300 sums and differences of columns overflow; no run comes near.
    [[nodiscard]] double number(const std::string& name) const {
        if (!(std::abs(line_.at(name)) <= 1e300)) {
            bad_field(line_.where, name, fmt::format("{}", line_.at(name)), "a finite number");
        }
        return line_.at(name);
    }
    /// An interval may be unbounded, a smallest of nothing is inf.
    [[nodiscard]] double number_or_infinite(const std::string& name) const {
        return std::isinf(line_.at(name)) ? line_.at(name) : number(name);
    }
    [[nodiscard]] int integer(const char* name, int lowest) const {
        if (line_.integer(name) < lowest) {
            bad_field(line_.where, name, fmt::format("{}", line_.at(name)), fmt::format("an integer from {}", lowest));
        }
        return line_.integer(name);
    }

  private:
    const EquilibriumLine& line_;
};

EquilibriumRow row_of(const EquilibriumLine& line) {
    const Fields fields(line);
    const RecordColumns& names = *line.names;
    EquilibriumRow row;
    row.number = fields.integer("number", 0);
    row.previous = fields.integer("previous", -1);
    row.segment = fields.integer("segment", 0);
    row.stress = fields.number(names.stress);
    row.ratio = fields.number("ratio");
    row.strain1 = fields.number(names.other_strain);
    row.strain2 = fields.number(names.strain);
    for (std::size_t a = 0; names.dimension != plane && a < most_axes; ++a) {
        row.length.push_back(fields.number(names.measures[a].length));
    }
    row.solid_fraction = fields.number("solid_fraction");
    row.arcs = fields.integer("arcs", 0);
    row.rattlers = fields.integer("rattlers", 0);
    row.backbone = fields.integer("backbone", 0);
    row.hyperstaticity = fields.integer("h", 0);
    row.stress_low = fields.number_or_infinite(names.stress + "_low");
    row.stress_high = fields.number_or_infinite(names.stress + "_high");
    row.min_force = fields.number_or_infinite("min_force");
    row.min_gap = fields.number_or_infinite("min_gap");
    row.margin = fields.number_or_infinite("margin");
    row.proved = fields.integer("proved", 0) == 1;
    return row;
}

} // namespace

RecordColumns record_columns(const MoreColumns& more) {
    Load load;
    load.dimension = more.dimension;
    load.loaded_axis = more.loaded_axis;
    if (more.path) {
        load.path.emplace();
    }
    return record_columns(load, more.tilt);
}

std::pair<int, int> contact_columns(const Contact& contact) {
    if (contact.i < 0 || contact.kind == ContactKind::held) {
        return {contact.i < 0 ? no_contact : contact.i, no_contact};
    }
    if (contact.is_wall()) {
        return {contact.i, contact.wall().column[static_cast<std::size_t>(contact.j)]};
    }
    return {contact.i, contact.kind == ContactKind::bar ? first_bar - contact.j : contact.j};
}

const std::set<std::string>& integer_columns() {
    static const std::set<std::string> names = [] {
        std::set<std::string> found;
        for_each_name({true, true}, [&found](const std::string& name, bool integers) {
            if (integers) {
                found.insert(name);
            }
        });
        return found;
    }();
    return names;
}

std::vector<std::string> equilibria_columns(MoreColumns more) {
    std::vector<std::string> all;
    for_each_name(more, [&all](const std::string& name, bool /*integers*/) { all.push_back(name); });
    all.emplace_back("seconds");
    return all;
}

std::string equilibria_header(MoreColumns more) {
    return fmt::format("# {}\n", fmt::join(equilibria_columns(more), ","));
}

MoreColumns named_columns(std::string_view text, const std::string& source) {
    for (const bool tilt : {false, true}) {
        for (const bool touching : {false, true}) {
            const int places = !tilt ? most_axes : most_axes + most_tilts;
            for (int loaded = -1; loaded <= places; ++loaded) { // -1: the plane; the last: a path
                const MoreColumns more = loaded < 0 ? MoreColumns{tilt, touching}
                                         : loaded == places
                                             ? MoreColumns{tilt, touching, most_axes, most_axes - 1, true}
                                             : MoreColumns{tilt, touching, most_axes, loaded};
                if (text.starts_with(equilibria_header(more))) {
                    return more;
                }
            }
        }
    }
    refuse(ErrorKind::bad_input, "{}:1: the names of the columns are not those of this program: expected {}", source,
           equilibria_header());
}

std::string equilibrium_row(const EquilibriumRecord& record, const State& state, int previous, MoreColumns more) {
    std::string text;
    for_each_column({record, state.packing.solid_fraction(), previous, record_columns(state.load, more.tilt), more},
                    [&text](const std::string& /*name*/, auto value) { text += fmt::format("{},", value); });
    return text + fmt::format("{:.3f}\n", record.seconds); // last: runs are compared without it
}

std::string records_text(const std::filesystem::path& path, LastLine last) {
    std::string text = read_text(path);
    if (last == LastLine::may_be_cut) {
        text.resize(text.rfind('\n') + 1); // npos + 1: no line at all
    }
    return text;
}

std::vector<EquilibriumLine> read_equilibrium_lines(const std::filesystem::path& path, LastLine last) {
    const std::string content = records_text(path, last);
    std::vector<EquilibriumLine> lines;
    if (content.empty()) {
        return lines;
    }
    const std::string source = path.string();
    TextLines text(content, source);
    const MoreColumns more = named_columns(without_byte_order_mark(content), source);
    const std::vector<std::string> names = equilibria_columns(more);
    const auto called = std::make_shared<const RecordColumns>(record_columns(more));
    (void)text.take("names of columns");
    while (!text.at_end()) {
        const std::string_view row = text.take("a row");
        EquilibriumLine& line = lines.emplace_back();
        line.where = fmt::format("{}:{}", source, text.number());
        line.names = called;
        std::vector<std::string_view> fields;
        for (std::size_t at = 0; at <= row.size(); at += fields.back().size() + 1) {
            fields.push_back(row.substr(at, row.find(',', at) - at));
        }
        if (fields.size() != names.size()) {
            refuse(line.where, "{} columns: expected {}, named by the first line", fields.size(), names.size());
        }
        for (std::size_t k = 0; k < names.size(); ++k) {
            line.value[names[k]] = number_of(fields[k], line.where, names[k]);
        }
    }
    return lines;
}

std::vector<EquilibriumRow> read_equilibria(const std::filesystem::path& path) {
    std::vector<EquilibriumRow> rows;
    if (std::filesystem::exists(path) && std::filesystem::file_size(path) == 0) {
        return rows; // columns are named with the first row
    }
    for (const EquilibriumLine& line : read_equilibrium_lines(path, LastLine::may_be_cut)) {
        rows.push_back(row_of(line));
    }
    return rows;
}

} // namespace isostat
