#include "core/work.hpp"
#include "io/files.hpp"
#include "io/json.hpp"
#include "io/state_json.hpp"
#include "packing/words.hpp"

#include <isostat/core/result.hpp>
#include <isostat/io/state_file.hpp>

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace isostat {

namespace {

using json::Json;

/// JSON has no NaN and no infinity: a state that holds one is not written at all.
double finite(double value, const char* field) {
    if (!std::isfinite(value)) {
        refuse(ErrorKind::bad_input, "{} is {}: expected a finite number in a state", field, value);
    }
    return value;
}

template <class Range> Json numbers(const Range& values, const char* field) {
    return json::array_of(values, [field](double value) { return finite(value, field); });
}

void append_numbers(std::string& text, std::span<const double> values, const char* field) {
    for (std::size_t k = 0; k < values.size(); ++k) {
        text += k == 0 ? '[' : ',';
        json::append_number(text, finite(values[k], field));
    }
}

/// The member "cell", or nothing in a box.
std::string cell_text(const Packing& packing) {
    return packing.cell.any() ? fmt::format("  \"cell\": {},\n", json::cell_json(packing).dump()) : "";
}

/// The members "length" and "disks".
void append_disks(std::string& text, const Packing& packing) {
    text += fmt::format("  \"length\": {},\n",
                        numbers(std::span(packing.q).subspan(packing.length_at(0), packing.axes()), "length").dump());
    const std::size_t axes = packing.axes();
    json::append_rows(text, "disks", packing.radius.size(), [&](std::string& to, std::size_t i) {
        append_numbers(to, std::span(packing.q).subspan(axes * i, axes), "disks (position)");
        to += ',';
        json::append_number(to, finite(packing.radius[i], "disks (radius)"));
        to += ']';
    });
}

/// The member "load", without the forces on disks.
std::string load_text(const State& state) {
    const Load& load = state.load;
    const std::size_t axes = state.packing.axes();
    const std::size_t tilts = state.packing.tilts();
    Json object;
    object["kind"] = word_of(load.kind, load_kind_words);
    object["stress"] = numbers(std::span(load.stress).first(axes), "load.stress");
    object["loaded_axis"] = load.loaded_axis;
    if (load.path) {
        const std::size_t places = state.packing.cell.shears() ? axes + tilts : axes;
        Json& path = object["path"];
        path["stress"] = numbers(std::span(load.path->at).first(places), "load.path.stress");
        path["direction"] = numbers(std::span(load.path->rate).first(places), "load.path.direction");
        path["t"] = finite(load.path->t, "load.path.t");
    }
    object["reference_length"] = numbers(std::span(load.reference_length).first(axes), "load.reference_length");
    if (state.packing.cell.any()) {
        object["shear"] = numbers(std::span(load.shear).first(tilts), "load.shear");
        object["reference_tilt"] = numbers(std::span(load.reference_tilt).first(tilts), "load.reference_tilt");
    }
    return fmt::format("  \"load\": {},\n", object.dump());
}

/// The member "walls".
std::string walls_text(const Packing& packing) {
    const Walls& walls = packing.walls;
    Json object;
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        object["lower"].push_back(word_of(walls.lower[a], wall_kind_words));
        object["upper"].push_back(word_of(walls.upper[a], wall_kind_words));
    }
    return fmt::format("  \"walls\": {},\n", object.dump());
}

/// A further member, unless it has no rows.
template <class Row> void append_member(std::string& text, const char* name, std::size_t count, Row row) {
    if (count > 0) {
        text += ",\n";
        json::append_rows(text, name, count, row);
    }
}
void append_member(std::string& text, const char* name, const std::vector<Json>& rows) {
    append_member(text, name, rows.size(), [&](std::string& to, std::size_t i) { to += rows[i].dump(); });
}

/// d numbers per disk, one row each.
void append_vectors(std::string& text, const char* name, const std::vector<double>& values, std::size_t axes) {
    append_member(text, name, values.size() / axes, [&](std::string& to, std::size_t i) {
        append_numbers(to, std::span(values).subspan(axes * i, axes), name);
        to += ']';
    });
}

void append_contact(std::string& text, const Contact& contact, int dimension) {
    if (contact.kind == ContactKind::disk_disk && contact.image.is_here()) { // most contacts are such
        fmt::format_to(std::back_inserter(text), "[{},{}]", contact.i, contact.j);
    } else {
        text += json::contact_to_json(contact, dimension).dump();
    }
}

} // namespace

json::Json json::cell_json(const Packing& packing) {
    const Cell& cell = packing.cell;
    Json object;
    object["moves"] = Json::array();
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        object["axes"].push_back(cell.periodic[a] ? "periodic" : "walls");
        if (cell.period_moves[a]) { // of a cell that keeps its shape: the last one
            object["moves"].push_back(cell.keeps_shape ? "scale" : axis_names[a]);
        }
    }
    for (std::size_t t = 0; t < packing.tilts(); ++t) {
        object["tilt"].push_back(finite(packing.q[packing.length_at(packing.axes() + t)], "cell.tilt"));
        if (cell.tilt_moves[t]) {
            object["moves"].push_back(tilt_names[t]);
        }
    }
    object["pin"] = cell.pin;
    return object;
}

std::string state_text(const State& state, std::span<const double> forces) {
    const Packing& packing = state.packing;
    std::string text = "{\n  \"format\": \"isostat-state\",\n  \"version\": 2,\n";
    text += fmt::format("  \"dimension\": {},\n  \"equilibrium\": {},\n", packing.dimension, state.equilibrium);
    text +=
        fmt::format("  \"provenance\": {},\n", state.provenance.empty() ? "{}" : Json::parse(state.provenance).dump());
    text += load_text(state);
    text += walls_text(packing);
    text += cell_text(packing);
    append_disks(text, packing);

    std::vector<Json> rows;
    for (std::size_t i = 0; i < packing.fixed.size(); ++i) {
        if (packing.fixed[i] != 0) {
            rows.emplace_back(i);
        }
    }
    append_member(text, "fixed", rows);
    rows.clear();
    for (const Bar& bar : packing.bars) {
        rows.push_back(Json::array({bar.i, bar.j, finite(bar.length, "bars (length)")}));
    }
    append_member(text, "bars", rows);
    append_member(text, "arcs", {packing.arcs.begin(), packing.arcs.end()});
    append_vectors(text, "disk_force", state.load.disk_force, packing.axes());
    append_vectors(text, "infinitesimal", state.load.infinitesimal, packing.axes());
    if (state.perturbation) {
        text += fmt::format(",\n  \"perturbation\": {}",
                            json::perturbation_to_json(*state.perturbation, packing.dimension).dump());
    }
    text += ",\n";
    json::append_rows(text, "contacts", state.contacts.size(), [&](std::string& to, std::size_t l) {
        append_contact(to, state.contacts[l], packing.dimension);
    });
    append_member(text, "forces", forces.size(),
                  [&](std::string& to, std::size_t l) { json::append_number(to, finite(forces[l], "forces")); });
    return text + "\n}\n";
}

void write_state(const std::filesystem::path& path, const State& state, std::span<const double> forces) {
    count_work(Work::states_written);
    write_output(path, state_text(state, forces), "\"isostat-state\"");
}

void write_packing(const std::filesystem::path& path, const Packing& packing, const std::string& reason) {
    std::string text = "{\n  \"format\": \"isostat-packing\",\n  \"version\": 2,\n";
    text += fmt::format("  \"incomplete\": {},\n", json::dumped(reason));
    append_disks(text, packing);
    write_output(path, text + "\n}\n", "\"isostat-packing\"");
}

} // namespace isostat
