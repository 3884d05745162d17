#include "core/refuse.hpp"
#include "io/files.hpp"
#include "io/json.hpp"
#include "io/state_json.hpp"
#include "io/text.hpp"
#include "io/vertex_text.hpp"
#include "packing/arc_bodies.hpp"
#include "packing/load_faults.hpp"
#include "packing/words.hpp"

#include <isostat/io/state_file.hpp>

#include <gmpxx.h>

#include <algorithm>
#include <cmath>

namespace isostat {

namespace {

using json::Field;

/// d numbers per disk; the array may be absent.
std::vector<double> vectors(const Field& document, const char* name, const Layout& layout) {
    std::vector<double> values;
    if (!document.has(name)) {
        return values;
    }
    const Field list = document.at(name);
    list.require_size(static_cast<std::size_t>(layout.disks), "one row per disk");
    values.reserve(layout.of_length(0));
    for (std::size_t i = 0; i < list.size(); ++i) {
        const std::vector<double> row = list.at(i).numbers(layout.axes(), "one number per axis");
        values.insert(values.end(), row.begin(), row.end());
    }
    return values;
}

/// Version 1 has rows [radius, x, y], version 2 [x, y, radius].
void read_disks(const Field& document, Packing& packing) {
    const bool radius_first = document.at("version").integer() == 1;
    const char* const order = radius_first             ? "[radius, x, y]"
                              : packing.dimension == 3 ? "[x, y, z, radius]"
                                                       : "[x, y, radius]";
    const std::size_t first = radius_first ? 1 : 0;
    const std::size_t size = radius_first ? 0 : packing.axes();
    const Field disks = document.at("disks");
    if (disks.size() == 0) {
        disks.fail("at least one disk {}", order);
    }
    for (std::size_t i = 0; i < disks.size(); ++i) {
        const Field row = disks.at(i);
        row.require_size(1 + packing.axes(), order);
        const double radius = row.at(size).number();
        if (!(radius > 0)) {
            row.at(size).fail("a positive radius");
        }
        packing.radius.push_back(radius);
        for (std::size_t a = 0; a < packing.axes(); ++a) {
            packing.q.push_back(row.at(first + a).number());
        }
    }
}

enum class Axis : unsigned char { periodic, walls };

/// The names of the coordinates of a cell that move.
void read_moves(const Field& moves, Packing& packing) {
    Cell& cell = packing.cell;
    for (std::size_t k = 0; k < moves.size(); ++k) {
        const std::string& name = moves.at(k).string();
        for (std::size_t before = 0; before < k; ++before) {
            if (moves.at(before).string() == name) {
                moves.at(k).fail("each coordinate once");
            }
        }
        bool known = name == "scale";
        if (known && (moves.size() != 1 || !cell.all())) {
            moves.at(k).fail("\"scale\" alone, where every axis is periodic: it is what moves of an isotropic cell");
        }
        if (known) {
            cell.keep_shape();
        }
        for (std::size_t a = 0; a < packing.axes(); ++a) {
            known = known || name == axis_names[a];
            cell.period_moves[a] = cell.period_moves[a] || name == axis_names[a];
        }
        for (std::size_t t = 0; t < packing.tilts(); ++t) {
            known = known || name == tilt_names[t];
            cell.tilt_moves[t] = cell.tilt_moves[t] || name == tilt_names[t];
        }
        if (!known) {
            moves.at(k).fail(packing.dimension == plane
                                 ? "\"x\", \"y\" (periods), \"xy\" (tilt) or \"scale\" (isotropic)"
                                 : "periods \"x\" to \"z\", tilts \"xy\", \"xz\", \"yz\", or \"scale\" (isotropic)");
        }
    }
}

/// Axes that repeat have no walls; the others keep those of a box unless "walls" says otherwise.
void read_cell(const Field& field, Packing& packing) {
    field.only({"axes", "moves", "tilt", "pin"});
    Cell& cell = packing.cell;
    const Field axes = field.at("axes");
    axes.require_size(packing.axes(), "one word per axis");
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        cell.periodic[a] = axes.at(a).word(words_of<Axis>("periodic", "walls")) == Axis::periodic;
        if (cell.periodic[a]) {
            packing.walls.lower[a] = packing.walls.upper[a] = WallKind::absent;
        }
    }
    if (!cell.any()) {
        axes.fail("a periodic axis; a box has no \"cell\"");
    }
    read_moves(field.at("moves"), packing);
    const std::vector<double> tilt = field.has("tilt")
                                         ? field.at("tilt").numbers(packing.tilts(), "one tilt per pair of axes")
                                         : std::vector<double>(packing.tilts(), 0);
    packing.q.insert(packing.q.end(), tilt.begin(), tilt.end());
    if (field.has("pin")) {
        cell.pin = field.at("pin").integer(0, packing.disk_count() - 1);
    }
}

/// What bars connect, and which bodies arcs bound.
void read_bodies(const Field& document, Packing& packing) {
    const auto disk = [&](const Field& field) { return field.integer(0, packing.disk_count() - 1); };
    for (std::size_t k = 0; document.has("bars") && k < document.at("bars").size(); ++k) {
        const Field bar = document.at("bars").at(k);
        bar.require_size(3, "[disk, disk, length]");
        packing.bars.push_back(
            {disk(bar.at(std::size_t{0})), disk(bar.at(std::size_t{1})), bar.at(std::size_t{2}).number()});
    }
    std::ranges::sort(packing.bars);
    for (std::size_t b = 0; document.has("arcs") && b < document.at("arcs").size(); ++b) {
        const Field ring = document.at("arcs").at(b);
        packing.arcs.emplace_back();
        for (std::size_t k = 0; k < ring.size(); ++k) {
            packing.arcs.back().push_back(disk(ring.at(k)));
        }
    }
}

Packing packing_of(const Field& document) {
    Packing packing;
    if (document.has("dimension")) {
        packing.dimension = packing.cell.dimension = document.at("dimension").integer(2, 3);
        packing.walls = Walls::box(packing.dimension);
    }
    read_disks(document, packing);
    const std::vector<double> length = document.at("length").numbers(packing.axes(), "one length per axis");
    packing.q.insert(packing.q.end(), length.begin(), length.end());
    if (document.has("cell")) {
        read_cell(document.at("cell"), packing);
    }
    if (document.has("walls")) {
        const Field walls = document.at("walls");
        walls.only({"lower", "upper"});
        walls.at("lower").require_size(packing.axes(), "one wall per axis");
        walls.at("upper").require_size(packing.axes(), "one wall per axis");
        for (std::size_t a = 0; a < packing.axes(); ++a) {
            packing.walls.lower[a] = walls.at("lower").at(a).word(wall_kind_words);
            packing.walls.upper[a] = walls.at("upper").at(a).word(wall_kind_words);
            if (packing.walls.lower[a] == WallKind::movable) {
                walls.at("lower").at(a).fail("\"absent\" or \"fixed\": the lower walls are the origin");
            }
        }
    }
    if (document.has("fixed")) {
        const Field fixed = document.at("fixed");
        packing.fixed.assign(fixed.size() > 0 ? packing.radius.size() : 0, 0);
        for (std::size_t k = 0; k < fixed.size(); ++k) {
            const long i = fixed.at(k).integer();
            if (i < 0 || i >= packing.disk_count()) {
                fixed.at(k).fail("a disk from 0 to {}", packing.disk_count() - 1);
            }
            if (packing.fixed[static_cast<std::size_t>(i)] != 0) {
                fixed.at(k).fail("each disk once");
            }
            packing.fixed[static_cast<std::size_t>(i)] = 1;
        }
    }
    read_bodies(document, packing);
    return packing;
}

/// Lists that name no bar have all of them; the others name each.
void complete_bars(State& state, const std::string& source) {
    const std::vector<Bar>& bars = state.packing.bars;
    const auto listed = static_cast<std::size_t>(
        std::ranges::count_if(state.contacts, [](const Contact& c) { return c.kind == ContactKind::bar; }));
    if (listed != 0 && listed != bars.size()) {
        refuse(source, "contacts has {} of {} bars: expected all, or to leave them out", listed, bars.size());
    }
    for (std::size_t k = listed; k < bars.size(); ++k) {
        state.contacts.push_back({ContactKind::bar, bars[k].i, bars[k].j});
    }
}

void require_balance(const Field& document, const char* name, const std::vector<double>& values, const Cell& cell) {
    if (const auto rest = unbalanced<mpq_class>(values, cell)) {
        refuse(ErrorKind::bad_input,
               "{} along {} sum to {:.3g}: expected exactly 0 along a periodic axis (give one disk minus the sum of "
               "the others)",
               document.at(name).where(), axis_names[rest->first], rest->second.get_d());
    }
}

/// Shear stresses, and the tilts that shear counts from.
void read_tilts(const Field& field, const Packing& packing, Load& load) {
    if (field.has("shear")) {
        const Field shear = field.at("shear");
        shear.require_size(packing.tilts(), "one shear stress per tilt");
        for (std::size_t t = 0; t < packing.tilts(); ++t) {
            load.shear[t] = shear.at(t).number();
            if (load.shear[t] != 0 && !packing.cell.tilt_moves[t]) {
                shear.at(t).fail("0, as that tilt does not move");
            }
        }
    }
    if (field.has("reference_tilt")) {
        const std::vector<double> tilt =
            field.at("reference_tilt")
                .numbers(packing.cell.any() ? packing.tilts() : 0, "one number per tilt of a periodic cell");
        std::ranges::copy(tilt, load.reference_tilt.begin());
    } else if (field.has("reference_length")) {
        load.reference_tilt.fill(0); // a rectangle
    }
}

/// "path": stresses that change together; "stress" and "shear" are what they are at t.
void read_path(const Field& field, const Packing& packing, Load& load) {
    const Field path = field.at("path");
    path.only({"stress", "direction", "t"});
    const std::vector<double> rates = path.at("direction").numbers();
    if (const std::string fault = fault_of_path(packing, rates); !fault.empty()) {
        refuse(path.at("direction").where(), "a direction in the space of stresses, {}", fault);
    }
    const Field stress = path.at("stress");
    const std::vector<double> start = stress.numbers(rates.size(), "as many numbers as direction has");
    const Load said = load;
    StressPath& along = load.path.emplace();
    std::ranges::copy(rates, along.rate.begin());
    std::ranges::copy(start, along.at.begin());
    const double t = path.at("t").number();
    constexpr double farthest = 1e200; // the parts of a product with a rate are doubles then (`exact_stress`)
    if (t != 0 && !(std::abs(t) >= 1 / farthest && std::abs(t) <= farthest)) {
        path.at("t").fail("0, or a magnitude from 1e-200 to 1e200");
    }
    load.set_loaded_stress(t);
    if (!(load.other_stress() > 0)) {
        stress.fail("a mean stress above 0");
    }
    const bool differs = (field.has("stress") && said.stress != load.stress) ||
                         (field.has("shear") && said.shear != load.shear) || load.loaded_axis != packing.dimension - 1;
    if (differs) {
        field.fail("stress and shear that are path.stress + t path.direction, to the nearest double, and the last axis "
                   "as loaded_axis");
    }
}

Load load_of(const Field& document, const Packing& packing) {
    Load load;
    std::fill_n(load.stress.begin(), packing.dimension, 1);
    load.dimension = packing.dimension;
    load.loaded_axis = packing.dimension - 1;
    load.refer_to(packing);
    if (document.has("load")) {
        const Field field = document.at("load");
        field.only({"kind", "stress", "loaded_axis", "path", "reference_length", "reference_tilt", "shear"});
        if (field.has("kind")) {
            load.kind = field.at("kind").word(load_kind_words);
            const auto& tilts = packing.cell.tilt_moves;
            if (load.kind == LoadKind::true_stress && std::ranges::find(tilts, true) != tilts.end()) {
                field.at("kind").fail("\"nominal\" where a tilt moves: true stresses have no potential there");
            }
        }
        read_tilts(field, packing, load);
        for (const char* name : {"stress", "reference_length"}) {
            if (!field.has(name)) {
                continue;
            }
            field.at(name).require_size(packing.axes(), "one number per axis");
            for (std::size_t a = 0; a < packing.axes(); ++a) {
                const Field number = field.at(name).at(a);
                const bool is_stress = name == std::string("stress");
                (is_stress ? load.stress : load.reference_length)[a] = number.number();
                if (!is_stress && !(number.number() > 0)) {
                    number.fail("a positive length");
                }
            }
        }
        if (field.has("loaded_axis")) {
            const long axis = field.at("loaded_axis").integer();
            const auto& tilts = packing.cell.tilt_moves;
            const bool any_tilt = packing.cell.any() && std::ranges::find(tilts, true) != tilts.end();
            const bool is_tilt = any_tilt && axis >= packing.dimension && axis < packing.dimension + long{most_tilts} &&
                                 tilts[static_cast<std::size_t>(axis - packing.dimension)];
            if (!is_tilt && (axis < 0 || axis >= packing.dimension)) {
                field.at("loaded_axis")
                    .fail("an axis from 0 to {}{}", packing.dimension - 1,
                          !any_tilt                    ? ""
                          : packing.dimension == plane ? ", or the tilt, 2"
                                                       : ", or a tilt that moves, from 3 on");
            }
            load.loaded_axis = static_cast<int>(axis);
        }
        if (field.has("path")) {
            read_path(field, packing, load);
        }
    }
    load.disk_force = vectors(document, "disk_force", packing.layout());
    load.infinitesimal = vectors(document, "infinitesimal", packing.layout());
    require_balance(document, "disk_force", load.disk_force, packing.cell);
    if (packing.cell.keeps_shape && std::ranges::any_of(load.disk_force, [](double f) { return f != 0; })) {
        document.at("disk_force").fail("no force on a disk, as the cell keeps its shape");
    }
    require_balance(document, "infinitesimal", load.infinitesimal, packing.cell);
    return load;
}

StateFile of_box(StateFile file, const std::string& source) {
    require_box(file.state.packing, source, "run, inspect, plateau, certify and verify take it, this command");
    return file;
}

} // namespace

StateFile json::state_from_json(const Field& document, const std::string& source) {
    if (!document.value().is_object()) {
        document.fail("an object with \"format\": \"isostat-state\"");
    }
    if (document.at("format").string() != "isostat-state") {
        document.at("format").fail("\"isostat-state\"");
    }
    if (const long version = document.at("version").integer(); version != 1 && version != 2) {
        document.at("version").fail("1 or 2, the versions that this program reads");
    }
    document.only({"format", "version", "dimension", "equilibrium", "provenance", "load", "walls", "length", "cell",
                   "disks", "fixed", "bars", "arcs", "disk_force", "infinitesimal", "perturbation", "contacts",
                   "forces"});
    StateFile file;
    State& state = file.state;
    state.packing = packing_of(document);
    validate(state.packing, source);
    state.load = load_of(document, state.packing);
    require_pressed_sides(state.packing, state.load,
                          document.has("load") && document.at("load").has("reference_length"), source);
    if (document.has("equilibrium")) {
        const long number = document.at("equilibrium").integer();
        if (number < 0 || number > 1'000'000'000) {
            document.at("equilibrium").fail("the number of an equilibrium, from 0");
        }
        state.equilibrium = static_cast<int>(number);
    }
    if (document.has("provenance")) {
        state.provenance = document.at("provenance").value().dump();
    }
    const Field contacts = document.at("contacts");
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        state.contacts.push_back(json::contact_from_json(contacts.at(l), state.packing));
    }
    json::refuse_duplicates(state.contacts, state.packing.dimension, source, "contacts");
    complete_bars(state, source);
    if (document.has("perturbation")) {
        state.perturbation = json::perturbation_from_json(document.at("perturbation"), state.packing);
    }
    if (document.has("forces")) {
        file.forces = document.at("forces").numbers(state.contacts.size(), "one force per contact");
    }
    return file;
}

StateFile parse_any_state(const std::string& text, const std::string& source, Dimensions dimensions) {
    const json::Json parsed = Field::parse(text, source);
    StateFile file = json::state_from_json(Field(parsed, source), source);
    if (dimensions != Dimensions::any_bodies) {
        require_no_arcs(file.state.packing, source, "this command");
    }
    if (dimensions < Dimensions::any_clumps) {
        require_single_grains(file.state.packing, source, "this command");
    }
    if (dimensions == Dimensions::two) {
        require_plane(file.state.packing, source, "this command");
    }
    return file;
}

StateFile parse_state(const std::string& text, const std::string& source) {
    return of_box(parse_any_state(text, source), source);
}

StateFile read_state(const std::filesystem::path& path) {
    return of_box(read_any_state(path), path.string());
}

StateFile read_any_state(const std::filesystem::path& path, Dimensions dimensions) {
    const std::string text = read_text(path);
    const std::string_view content = without_byte_order_mark(text);
    if (content[content.find_first_not_of(" \t\r\n")] == '{') {
        return parse_any_state(text, path.string(), dimensions);
    }
    try {
        return {parse_vertex_text(text, path.string()), {}};
    } catch (const Error& error) {
        const std::string format = recognise_format(text);
        if (format == "state" || format == "vertex") {
            throw;
        }
        if (format.starts_with("lammps") || (format == "xyz" && text.find("Properties=") != std::string::npos)) {
            refuse(error.kind(),
                   "{}: a packing of another program ({}): expected a state or a vertex text; isostat import makes a "
                   "state of it",
                   path.string(), format);
        }
        // The first line that is no comment: where it begins with a number, what is wrong with the vertex text was
        // told.
        std::size_t begin = content.find_first_not_of(" \t\r\n");
        while (begin != std::string_view::npos && content[begin] == '#') {
            begin = content.find_first_not_of(" \t\r\n", std::min(content.find('\n', begin), content.size()));
        }
        const std::string_view rest = begin == std::string_view::npos ? content : content.substr(begin);
        if (rest.front() >= '0' && rest.front() <= '9') {
            throw;
        }
        constexpr std::size_t few = 40;
        refuse(error.kind(),
               "{}: neither a state (JSON) nor a vertex text (the number of disks comes first; isostat import reads "
               "packings of other programs): it begins with '{}'",
               path.string(), text::shown(rest.substr(0, std::min(rest.find('\n'), few))));
    }
}

} // namespace isostat
