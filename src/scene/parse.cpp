#include "core/refuse.hpp"
#include "io/files.hpp"
#include "io/section.hpp"
#include "io/text.hpp"
#include "packing/words.hpp"
#include "scene/settings.hpp"

#include <isostat/io/state_file.hpp>
#include <isostat/scene/scene.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>

namespace isostat {

namespace {

constexpr double largest_number = 1e300;

/// A TOML integer is signed, so that a seed is a non-negative one.
constexpr long largest_seed = std::numeric_limits<long>::max();

/// Below this value the doubles near a radius are too few for different radii.
constexpr double smallest_jitter = 1e-14;
constexpr double largest_jitter = 0.1;

/// Takes a list of radii from [packing].
void read_radii_list(SceneSection& section, const std::vector<double>& radii, PreparationOptions& options) {
    if (radii.empty()) {
        section.fail("radii", "at least one radius");
    }
    for (std::size_t i = 0; i < radii.size(); ++i) {
        if (!(radii[i] >= smallest_size && radii[i] <= largest_size)) {
            section.refuse("radii", "radii[{}] in [packing] is {}: expected a positive radius, from {} to {}", i,
                           radii[i], smallest_size, largest_size);
        }
    }
    options.radii = radii;
    section.record("radii", fmt::format("[{}]", fmt::join(radii, ", ")));
}

/// Takes a file to start from, which replaces the preparation.
void read_start(SceneSection& section, const std::string& file, Scene& scene, const std::filesystem::path& folder) {
    for (const char* key : {"jitter", "seed", "aspect"}) {
        if (section.has(key)) {
            section.refuse(key, "'{}' in [packing] is of a preparation: a packing read from a file has none", key);
        }
    }
    scene.start = *section.file("file", folder);
    section.record("file", toml_text(file));
}

/// The dimension of a list of radii or of a file of radii is a key; other sources have their own dimension.
int read_dimension(SceneSection& section, const std::string& source) {
    const bool list = source == "radii" || source == "radii_file";
    if (section.integer("dimension")) {
        if (list) {
            return static_cast<int>(section.integer("dimension", plane, plane, most_axes));
        }
        section.refuse("dimension",
                       "'dimension' in [packing] goes with 'radii' or 'radii_file' and has no meaning with '{}'",
                       source);
    }
    return source == "spheres" ? 3 : plane;
}

/// Reads the one source of the disks or spheres; throws unless it is exactly one.
void read_packing(SceneSection& section, Scene& scene, const std::filesystem::path& folder) {
    const auto file = section.string("file");
    const auto disks = section.integer("disks");
    const auto spheres = section.integer("spheres");
    const auto radii = section.numbers("radii");
    const auto radii_file = section.string("radii_file");
    const std::array<std::pair<const char*, bool>, 5> sources{{{"file", file.has_value()},
                                                               {"disks", disks.has_value()},
                                                               {"spheres", spheres.has_value()},
                                                               {"radii", radii.has_value()},
                                                               {"radii_file", radii_file.has_value()}}};
    const auto chosen = std::ranges::find_if(sources, [](const auto& s) { return s.second; });
    if (chosen == sources.end()) {
        section.refuse(
            "",
            "[packing] does not say where the grains come from: expected file, disks, radii or radii_file, or spheres");
    }
    for (auto other = chosen + 1; other != sources.end(); ++other) {
        if (other->second) {
            section.refuse(other->first, "'{}' and '{}' in [packing] exclude each other: expected one of them",
                           chosen->first, other->first);
        }
    }
    if (!disks && !spheres) {
        refuse_law(section, chosen->first);
    }
    PreparationOptions& options = scene.preparation;
    options.dimension = read_dimension(section, chosen->first);
    if (file) {
        read_start(section, *file, scene, folder);
        return;
    }
    if (disks || spheres) {
        options.disks = static_cast<int>(section.integer(chosen->first, 0, 1, 10'000'000));
        options.diameters = read_law(section);
    } else if (radii) {
        read_radii_list(section, *radii, options);
    } else {
        options.radii = read_radii(*section.file("radii_file", folder));
        section.record("radii_file", toml_text(*radii_file));
    }
    options.jitter = section.number("jitter", options.jitter, 0, largest_jitter, "0, or a number from 1e-14 to 0.1");
    if (options.jitter > 0 && options.jitter < smallest_jitter) {
        section.fail("jitter", "0, or a number from 1e-14 to 0.1");
    }
    options.seed = static_cast<std::uint64_t>(section.integer("seed", 1, 0, largest_seed));
    options.aspect = section.number("aspect", options.aspect, 0.01, 100, "a number from 0.01 to 100");
}

/// Reads [cell], with which the packing has no walls.
void read_cell(SceneSection& section, Scene& scene) {
    PreparationOptions& options = scene.preparation;
    if (!scene.start.empty()) {
        section.refuse("", "[cell] is of a preparation: a packing read from a file has its own");
    }
    constexpr std::array kinds{PreparedCell::rectangular, PreparedCell::tilted, PreparedCell::isotropic};
    const bool in_plane = options.dimension == plane;
    options.cell = kinds[section.word(
        "kind", 0, {in_plane ? "rectangular" : "orthorhombic", in_plane ? "tilted" : "triclinic", "isotropic"})];
    const std::size_t count = options.radii.empty() ? static_cast<std::size_t>(options.disks) : options.radii.size();
    if (count > static_cast<std::size_t>(options.large_above)) {
        section.refuse("", "[cell] and {} {}: expected at most {} in a periodic cell", count,
                       in_plane ? "disks" : "spheres", options.large_above);
    }
}

void read_preparation(SceneSection& section, Scene& scene) {
    PreparationOptions& options = scene.preparation;
    options.loose_fraction =
        section.number("loose_fraction", options.start_fraction(), 0.05, 0.8, "a solid fraction from 0.05 to 0.8");
    options.softness = section.number("softness", options.softness, 1e-9, 1e-3, "a number from 1e-9 to 1e-3");
    options.relaxation = section.number("relaxation", options.relaxation, 1e-12, 1, "a number from 1e-12 to 1");
    options.max_steps = section.integer("max_steps", options.max_steps, 1, 1'000'000'000);
    options.infinitesimal_weight = section.number("infinitesimal_weight", options.infinitesimal_weight, 1e-12, 1e-3,
                                                  "a number from 1e-12 to 1e-3");
    options.max_programmes = static_cast<int>(section.integer("max_programmes", options.max_programmes, 1, 100'000));
}

/// A protocol that changes several stresses at once, as in a triaxial test.
struct Protocol {
    const char* word;
    std::vector<double> path;
};
const std::array protocols{Protocol{"compression", {0, 0, 1}}, Protocol{"extension", {0, 0, -1}},
                           Protocol{"constant_mean", {-1, -1, 2}}};

/// Reads [load] direction, or a protocol. A prepared packing moves in all its lengths.
void read_path(SceneSection& section, Scene& scene) {
    PreparationOptions& options = scene.preparation;
    const bool prepares = scene.start.empty();
    std::string key = "loaded";
    if (const auto numbers = section.numbers("direction")) {
        key = "direction";
        if (!scene.loaded.empty()) {
            section.refuse(key, "'loaded' and 'direction' in [load] exclude each other: expected one of them");
        }
        scene.path = *numbers;
        section.record(key, fmt::format("[{}]", fmt::join(*numbers, ", ")));
    } else if (scene.path.empty()) {
        return;
    }
    Packing any;
    any.dimension = prepares ? options.dimension : static_cast<int>(most_axes);
    any.radius = {1};
    any.walls = Walls::box(any.dimension);
    if (!prepares || options.cell != PreparedCell::none) {
        any.cell.dimension = any.dimension;
        any.walls = Walls::none();
        any.cell.repeat();
        any.cell.move(true, !prepares || options.cell == PreparedCell::tilted);
    }
    any.q.assign(any.coordinate_count(), 1);
    if (const std::string fault = fault_of_path(any, scene.path); !fault.empty()) {
        section.refuse(key, "'{}' in [load] is a direction in the space of stresses, {}", key, fault);
    }
    if (prepares) {
        std::ranges::copy(scene.path, options.path.emplace().begin());
    }
}

/// Reads which stress the programme changes.
void read_loaded(SceneSection& section, Scene& scene) {
    if (!section.string("loaded")) { // without this key the state of a file decides
        return;
    }
    PreparationOptions& options = scene.preparation;
    const bool prepares = scene.start.empty(); // a state file has a dimension and states whether a tilt moves
    const bool in_plane = options.dimension == plane;
    std::vector<std::string> words{"x", "y", "z", "xy", "xz", "yz"};
    if (prepares && in_plane) {
        words = {"y", "tilt"};
    } else {
        std::ranges::transform(protocols, std::back_inserter(words), &Protocol::word);
    }
    if (!prepares) {
        words.emplace_back("tilt");
    }
    const std::size_t place = section.word("loaded", 0, words);
    scene.loaded = words[place];
    if (const auto* const found = std::ranges::find(protocols, scene.loaded, &Protocol::word);
        found != protocols.end()) {
        scene.path = found->path;
    }
    if (!prepares || !scene.path.empty()) {
        return;
    }
    options.loaded_axis = static_cast<int>(place) + (in_plane ? 1 : 0);
    if (*options.loaded_axis >= options.dimension && options.cell != PreparedCell::tilted) {
        section.refuse("loaded", "'loaded' in [load] is \"{}\" and no tilt moves: expected kind = \"{}\" in [cell]",
                       scene.loaded, in_plane ? "tilted" : "triclinic");
    }
}

/// The load at the start of a programme, whose dimension and axis decide the names of the ratios.
Load load_at_start(const Scene& scene) {
    Load load;
    if (scene.start.empty()) {
        load.dimension = scene.preparation.dimension;
        load.loaded_axis = scene.preparation.loaded_axis.value_or(load.dimension - 1);
        if (scene.preparation.path) {
            load.follow(*scene.preparation.path);
        }
        return load;
    }
    try {
        State state = read_any_state(scene.start, Dimensions::any_clumps).state;
        choose_loaded(state, scene, scene.start.string());
        return state.load;
    } catch (const Error&) { // the reader of the start reports the error
        load.loaded_axis = scene.loaded == "tilt" ? plane : 1;
        return load;
    }
}

void read_load(SceneSection& section, Scene& scene) {
    const bool has_file = !scene.start.empty();
    const auto infinitesimal = section.integer("infinitesimal_seed");
    const bool kind_given = section.has("kind");
    const auto sigma1 = section.number("sigma1");
    if (has_file && sigma1) {
        section.refuse("sigma1",
                       "'sigma1' in [load] is of a preparation: a packing read from a file has its own stresses");
    }
    if (!has_file && infinitesimal) {
        section.refuse("infinitesimal_seed",
                       "'infinitesimal_seed' in [load] is for a packing read from a file: a prepared packing rests on "
                       "its own infinitesimal loads, made from 'seed' in [packing]");
    }
    if (!has_file || kind_given) {
        scene.load_kind = section.word("kind", LoadKind::nominal, load_kind_words);
        scene.preparation.load = *scene.load_kind;
    } else {
        (void)section.string("kind");
    }
    if (!has_file) {
        if (sigma1 && !(*sigma1 > 0)) {
            section.fail("sigma1", "a positive stress");
        }
        if (scene.preparation.cell == PreparedCell::tilted && scene.preparation.load != LoadKind::nominal) {
            section.refuse("kind", "'kind' in [load] is \"true\" and the tilt of the [cell] moves: expected "
                                   "\"nominal\" (true stresses have no potential there), or another kind in [cell]");
        }
        scene.preparation.stress = section.number("sigma1", 1, 1e-100, 1e100, "a positive stress from 1e-100 to 1e100");
    }
    read_loaded(section, scene);
    read_path(section, scene);
    if (infinitesimal) {
        if (*infinitesimal < 0) {
            section.fail("infinitesimal_seed", "a seed that is not negative");
        }
        scene.infinitesimal_seed = static_cast<std::uint64_t>(*infinitesimal);
        section.record("infinitesimal_seed", fmt::format("{}", *infinitesimal));
    }
}

ProgrammeStep read_step(SceneSection& section, const Load& load) {
    ProgrammeStep step;
    step.from_zero = load.loads_tilt() || load.path;
    step.ratio = load.ratio_name();
    step.line = section.line_of("");
    if (!section.has("do")) {
        section.refuse("", "a [[programme]] segment has no 'do': expected \"up\", \"down\" or \"to\"");
    }
    step.action = section.word("do", Action::up, action_words);
    if (const auto equilibria = section.integer("equilibria")) {
        step.equilibria = static_cast<int>(section.integer("equilibria", 0, 1, 1'000'000'000));
    }
    if (const auto to = section.number("to")) {
        step.to = step.from_zero ? section.number("to", 0, -largest_number, largest_number, "a ratio " + step.ratio)
                                 : section.number("to", 0, 0, largest_number,
                                                  "a ratio " + step.ratio +
                                                      " that is not negative (one of the shear has either sign: loaded "
                                                      "= \"tilt\" in [load])");
    }
    if (const auto from = section.integer("from")) {
        step.from = static_cast<int>(section.integer("from", 0, 0, 1'000'000'000));
    }
    const auto name = section.string("name");
    if (name && !text::is_plain_line(*name)) {
        section.fail("name", "one line of text without control characters");
    }
    step.name = name.value_or(describe(step));
    section.record("name", toml_text(step.name));
    section.finish();
    return step;
}

/// A word that scenes once had, and the words to use instead.
struct RetiredWord {
    const char* key;
    const char* word;
    const char* instead;
};
constexpr std::array retired_words{
    RetiredWord{"rule", "steepest", "\"most_negative\", \"least_negative\" or \"least_index\", which verify confirms"},
    RetiredWord{"certify", "plain", "\"decisions\": every run proves the vertices on its way"},
    RetiredWord{"ties", "perturb", "\"choose\" with max_choices = 0"},
    RetiredWord{"ties", "class", "\"stop\", or \"choose\", which settles ties for radii that differ"},
};

void refuse_retired_words(SceneSection& section) {
    for (const RetiredWord& retired : retired_words) {
        if (section.string(retired.key) == retired.word) {
            section.fail(retired.key, retired.instead);
        }
    }
}

void read_run(SceneSection& section, Scene& scene) {
    RunOptions& run = scene.run;
    refuse_retired_words(section);
    run.rule = section.word("rule", run.rule, opening_rule_words);
    run.rule_seed =
        static_cast<std::uint64_t>(section.integer("rule_seed", static_cast<long>(run.rule_seed), 0, largest_seed));
    run.max_arcs = section.integer("max_arcs", run.max_arcs, 1, 1'000'000'000);
    run.max_strain = section.number("max_strain", run.max_strain, 1e-12, 1e6, "a positive strain");
    run.certify = section.word("certify", run.certify, certify_level_words);
    run.ties = section.word("ties", run.ties, tie_policy_words);
    for (const char* key : {"ties_seed", "max_choices"}) {
        if (section.integer(key) && !run.at_first_order()) {
            section.refuse(key, "'{}' in [run] belongs to ties = \"choose\": with ties = \"stop\" it has no meaning",
                           key);
        }
    }
    if (run.at_first_order()) {
        run.ties_seed = static_cast<std::uint64_t>(section.integer("ties_seed", 1, 0, largest_seed));
    }
    if (section.integer("max_choices")) {
        run.max_choices = section.integer("max_choices", 0, 0, 1'000'000'000);
    }
    run.step_fraction = section.number("step_fraction", run.step_fraction, 1e-6, 10, "a number from 1e-6 to 10");
}

void read_output(SceneSection& section, Scene& scene) {
    scene.states_every = static_cast<int>(section.integer("states_every", scene.states_every, 0, 1'000'000'000));
    scene.checkpoint_seconds = section.number("checkpoint_seconds", scene.checkpoint_seconds, 0, 1e9,
                                              "a time in seconds that is not negative");
    scene.pictures = section.boolean("pictures", scene.pictures);
    scene.vtk = section.boolean("vtk", scene.vtk);
}

const toml::table* table_of(const toml::table& document, const char* name, const std::string& source) {
    const toml::node* node = document.get(name);
    if (node != nullptr && !node->is_table()) {
        refuse(ErrorKind::bad_input, "{}:{}: '{}' is not a table: expected [{}]", source, node->source().begin.line,
               name, name);
    }
    return node == nullptr ? nullptr : node->as_table();
}

void check_sections(const toml::table& document, const std::string& source) {
    static constexpr std::array<std::string_view, 7> sections{"packing",   "cell", "preparation", "load",
                                                              "programme", "run",  "output"};
    for (const auto& [key, node] : document) {
        if (std::ranges::find(sections, key.str()) == sections.end()) {
            refuse(ErrorKind::bad_input, "{}:{}: unknown section or key '{}': expected one of [{}]", source,
                   key.source().begin.line, key.str(), fmt::join(sections, "], ["));
        }
    }
}

void read_programme(const toml::table& document, Scene& scene) {
    const std::string& source = scene.file;
    if (const toml::node* node = document.get("programme")) {
        const toml::array* steps = node->as_array();
        if (steps == nullptr || !steps->is_homogeneous<toml::table>()) {
            refuse(ErrorKind::bad_input,
                   "{}:{}: 'programme' is not a list of tables: expected [[programme]] for each segment", source,
                   node->source().begin.line);
        }
        const bool ratios =
            std::ranges::any_of(*steps, [](const toml::node& step) { return step.as_table()->contains("to"); });
        const Load load = ratios ? load_at_start(scene) : Load();
        for (const toml::node& step : *steps) {
            SceneSection one(step.as_table(), "[programme]", source, scene.settings);
            scene.programme.push_back(read_step(one, load));
        }
    }
    if (scene.preparation.cell == PreparedCell::isotropic && !scene.programme.empty()) {
        refuse(source,
               "kind = \"isotropic\" in [cell] and a [[programme]]: a load on the size of a cell only scales the "
               "forces, no contact ever opens. Expected no programme (`prepare` takes such a cell), or another kind");
    }
}

} // namespace

Scene parse_scene(const std::string& text, const std::string& source, const std::filesystem::path& folder) {
    const toml::table document = parse_toml(without_byte_order_mark(text), source);
    check_sections(document, source);
    Scene scene;
    scene.file = source;
    scene.text = text;
    const auto read = [&](const char* name, const auto& fill) {
        SceneSection section(table_of(document, name, source), name, source, scene.settings);
        fill(section, scene);
        section.finish();
    };
    if (table_of(document, "packing", source) == nullptr) {
        refuse(source, "has no [packing]: expected one with file, disks, radii or radii_file, or spheres");
    }
    read("packing", [&](SceneSection& section, Scene& made) { read_packing(section, made, folder); });
    if (table_of(document, "cell", source) != nullptr) {
        read("cell", read_cell);
    }
    if (scene.start.empty()) {
        read("preparation", read_preparation);
    } else if (const toml::table* table = table_of(document, "preparation", source)) {
        refuse(ErrorKind::bad_input, "{}:{}: [preparation] has no meaning: the packing is read from a file", source,
               table->source().begin.line);
    }
    read("load", read_load);
    read_programme(document, scene);
    read("run", read_run);
    if (scene.run.certify == CertifyLevel::arcs && load_at_start(scene).path) {
        refuse(source, "certify = \"arcs\" in [run] and several stresses that change together: expected \"decisions\" "
                       "or \"states\", arcs are enclosed under loads with one");
    }
    read("output", read_output);
    std::optional<double> ratio;
    if (scene.start.empty()) {
        const Load load = load_at_start(scene);
        ratio = load.loads_tilt() || load.path ? 0 : 1; // isotropic stress
    }
    check_programme(scene, ratio);
    return scene;
}

Scene read_scene(const std::filesystem::path& path) {
    return parse_scene(read_text(path), path.string(), path.parent_path());
}

} // namespace isostat
