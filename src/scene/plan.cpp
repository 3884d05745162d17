#include <isostat/scene/scene.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace isostat {

namespace {

class Plan {
  public:
    void add(const char* kind, const char* name, bool used, const std::string& reason) {
        entries_.push_back({kind, name, used, reason});
    }
    std::vector<PlanEntry> take() { return std::move(entries_); }

  private:
    std::vector<PlanEntry> entries_;
};

/// Whether more than `disks` disks are prepared.
bool prepares_more(const Scene& scene, int disks) {
    const PreparationOptions& options = scene.preparation;
    const auto given = static_cast<int>(options.radii.size());
    return scene.start.empty() && (given > 0 ? given : options.disks) > disks;
}

/// Whether some radii of a preparation are equal before the jitter.
bool equal_radii(const PreparationOptions& options) {
    if (options.radii.empty()) {
        const DiameterLaw& law = options.diameters;
        return law.kind == RadiiLaw::equal || law.kind == RadiiLaw::bidisperse || law.smallest == law.largest;
    }
    std::vector<double> sorted = options.radii;
    std::ranges::sort(sorted);
    return std::ranges::adjacent_find(sorted) != sorted.end();
}

bool all_equal(const PreparationOptions& options) {
    const DiameterLaw& law = options.diameters;
    const auto& [least, most] = std::ranges::minmax_element(options.radii);
    return options.radii.empty() ? law.kind == RadiiLaw::equal || law.smallest == law.largest : *least == *most;
}

void add_stages(Plan& plan, const Scene& scene) {
    const bool prepares = scene.start.empty();
    const std::string given = fmt::format("the packing is read from {}", scene.start.string());
    plan.add("stage", "read the start", !prepares, prepares ? "the packing is prepared from random grains" : given);
    const double jitter = scene.preparation.jitter;
    plan.add("stage", "jitter of the radii", prepares && jitter > 0,
             !prepares ? given
             : jitter > 0
                 ? fmt::format("radii R_i (1 + {} rho_i), rho_i in [-1, 1) from the seed of the packing", jitter)
             : equal_radii(scene.preparation)
                 ? fmt::format("jitter = 0; the scene has equal radii, so that ties are common: jitter = {} in "
                               "[packing] makes them different",
                               all_equal(scene.preparation) ? "1e-4" : "1e-9")
                 : "jitter = 0; no radii are equal");
    std::string soft = "random grains to a relaxed soft packing";
    if (const int above = scene.preparation.newton_above; prepares_more(scene, above)) {
        soft += fmt::format(", with Newton steps at the end (more than {} disks)", above);
    }
    plan.add("stage", "damped dynamics", prepares, prepares ? soft : given);
    std::string rigid = "soft packing to a vertex: the contacts are the rows of the basis";
    if (const int above = scene.preparation.large_above; prepares_more(scene, above)) {
        rigid = fmt::format("soft packing to a vertex, after an interior-point descent (more than {} disks)", above);
    }
    plan.add("stage", "sequential linear programmes", prepares, prepares ? rigid : given);
    plan.add("stage", "Newton on the contacts", prepares, prepares ? "all gaps of the vertex to rounding" : given);
    const std::vector<double>& path = scene.path;
    plan.add("stage", "path in stress space", !path.empty(),
             path.empty()
                 ? "one stress changes, the others stay"
                 : fmt::format("t goes up or down, and {} change by {} each time that it changes by 1",
                               path.size() == most_axes ? "sigma1, sigma2, sigma3"
                                                        : "sigma1, sigma2, sigma3, shear_xy, shear_xz, shear_yz",
                               fmt::join(path, ", ")));
    plan.add("stage", "trajectory", !scene.programme.empty(),
             scene.programme.empty() ? "the scene has no [[programme]]"
                                     : fmt::format("{} segments", scene.programme.size()));
}

void add_solvers(Plan& plan, const Scene& scene) {
    const bool prepares = scene.start.empty();
    const bool runs = !scene.programme.empty();
    const bool nominal = scene.load_kind.value_or(LoadKind::nominal) == LoadKind::nominal;
    const bool random = scene.run.rule == OpeningRule::random;
    plan.add("solver", "regular triangulation (CGAL)", true,
             "complete contact candidates and the proof that nothing overlaps: made once, then carried along with the "
             "disks; where they overlap all pairs are swept");
    plan.add("solver", "elimination mod 2^61 - 1", true,
             "every contact matrix is proved regular before it is used in double precision");
    plan.add("solver", "sparse LU (KLU)", true, "forces and mechanisms");
    plan.add("solver", "double-double", true,
             "only where the bound of the double precision result does not decide a sign");
    const bool inside = prepares_more(scene, scene.preparation.newton_above);
    plan.add("solver", "dual simplex (Clp)", prepares && !inside,
             !prepares ? "there is no preparation"
             : inside  ? fmt::format("more than {} disks: interior points solve the programmes, unless they fail",
                                     scene.preparation.newton_above)
                       : "the linear programmes of the preparation");
    plan.add("solver", "infinitesimal loads", true,
             scene.infinitesimal_seed ? "rattlers rest on a contact for each axis; made from infinitesimal_seed"
             : prepares               ? "rattlers rest on a contact for each axis; made from the seed of the packing"
                                      : "rattlers rest on a contact for each axis; those of the start file");
    plan.add("solver", "descent of W", runs && nominal,
             !runs     ? "no trajectory"
             : nominal ? "wall forces are constant: W is proved to be smaller at the end of every arc"
                       : "true stresses: the sum of sigma ln L takes the place of W");
    plan.add("solver", "random choice of the contact that opens", runs && random,
             random ? "rule = \"random\"" : "the rule is deterministic: rule_seed is not used");
}

void add_proofs(Plan& plan, const Scene& scene) {
    const bool runs = !scene.programme.empty();
    const CertifyLevel level = scene.run.certify;
    const auto asked = [&](CertifyLevel least) {
        return runs && level >= least ? fmt::format("certify = \"{}\"", to_string(level))
               : runs                 ? fmt::format("certify = \"{}\": not asked for", to_string(level))
                                      : std::string("no trajectory");
    };
    plan.add("proof", "equilibria", runs,
             "rank (exact), sign of every force, both ends of the supported interval, no overlap");
    plan.add("proof", "decisions", runs,
             "every comparison that steers has a bound on both sides; ends of arcs proved, the way between them looked "
             "at; its cost is that of the run");
    plan.add("proof", "states", runs && level >= CertifyLevel::states,
             asked(CertifyLevel::states) +
                 "; the certificate of each equilibrium in certificates/; some 5 factorisations each");
    plan.add("proof", "arcs", runs && level >= CertifyLevel::arcs,
             asked(CertifyLevel::arcs) + "; each arc enclosed between its events, no contact missed; 4 to 8 "
                                         "factorisations per arc, more for long ones");
}

/// Adds the methods for signs and orders that doubles do not decide.
void add_last_resorts(Plan& plan, const Scene& scene) {
    const bool runs = !scene.programme.empty();
    plan.add("solver", "multiprecision (MPFR), exact numbers", true,
             "only where double-double does not decide a sign or an order");
    const bool settles = runs && scene.run.at_first_order();
    plan.add("solver", "first order in the radii", settles,
             !runs ? std::string("no trajectory")
             : settles
                 ? fmt::format(
                       "ties = \"choose\": ties are settled for radii R_i + eps rho_i, rho from seed {}{}; "
                       "hyperstatic starts are followed",
                       scene.run.ties_seed,
                       scene.run.chooses() ? ", and what they leave tied by the infinitesimal loads and the names" : "")
                 : "ties = \"stop\": a tie ends the run");
    plan.add("solver", "fixed disks, external forces on disks", false,
             "a scene has none; a start file in the state format may");
}

void add_outputs(Plan& plan, const Scene& scene) {
    const bool runs = !scene.programme.empty();
    const std::string none = "no trajectory: `prepare` writes one state";
    plan.add("output", "run.json, events.jsonl, equilibria.csv, checkpoint.json, summary.json", runs,
             runs ? "always" : none);
    const std::vector<int> needed = needed_equilibria(scene);
    plan.add("output", "states/eq_*.json", runs,
             !runs ? none
                   : fmt::format("number 0; the last of each segment{}{}{}",
                                 needed.empty()
                                     ? ""
                                     : fmt::format("; those that segments start from: {}", fmt::join(needed, ", ")),
                                 scene.states_every > 0 ? fmt::format("; every {}", scene.states_every) : "",
                                 "; the last one as last.json"));
    plan.add("output", "certificates/eq_*.json", runs && scene.run.certify >= CertifyLevel::states,
             !runs ? none
             : scene.run.certify >= CertifyLevel::states
                 ? fmt::format("certify = \"{}\"; `isostat verify` checks them", to_string(scene.run.certify))
                 : fmt::format("certify = \"{}\"", to_string(scene.run.certify)));
    plan.add("output", "certificates/arcs.jsonl", runs && scene.run.certify == CertifyLevel::arcs,
             !runs ? none
             : scene.run.certify == CertifyLevel::arcs
                 ? "certify = \"arcs\"; `isostat verify` proves the way of each arc from it"
                 : fmt::format("certify = \"{}\"", to_string(scene.run.certify)));
    plan.add("output", "figures/*.svg, *.png (gnuplot), force pictures", runs && scene.pictures,
             !runs            ? none
             : scene.pictures ? "pictures = true"
                              : "pictures = false; `isostat report` makes them later");
    plan.add("output", "figures/*.vtk", runs && scene.vtk,
             !runs       ? none
             : scene.vtk ? "vtk = true"
                         : "vtk = false; `isostat report --vtk` makes them later");
}

} // namespace

std::vector<PlanEntry> make_plan(const Scene& scene) {
    Plan plan;
    add_stages(plan, scene);
    add_solvers(plan, scene);
    add_proofs(plan, scene);
    add_last_resorts(plan, scene);
    add_outputs(plan, scene);
    return plan.take();
}

std::string settings_json(const Scene& scene) {
    nlohmann::ordered_json object = nlohmann::ordered_json::object();
    for (const Setting& setting : scene.settings) {
        if (setting.section == "[programme]") {
            continue; // a list, which the scene's text and `programme` contain
        }
        // Numbers, lists and booleans are written the same in TOML and JSON.
        const auto value = nlohmann::ordered_json::parse(setting.value, nullptr, false);
        object[setting.section][setting.key] = value.is_discarded() ? nlohmann::ordered_json(setting.value) : value;
    }
    return object.dump();
}

} // namespace isostat
