#include "cli/commands.hpp"
#include "cli/common.hpp"

#include <fmt/format.h>

namespace isostat::cli {

namespace {

void print_plan(const Scene& scene) {
    Json object;
    object["scene"] = scene.file;
    for (const PlanEntry& entry : make_plan(scene)) {
        object["plan"].push_back(
            {{"kind", entry.kind}, {"name", entry.name}, {"used", entry.used}, {"reason", entry.reason}});
    }
    object["programme"] = json::array_of(scene.programme, [](const ProgrammeStep& step) { return describe(step); });
    for (const Setting& setting : scene.settings) {
        object["settings"].push_back(
            {{"section", setting.section}, {"key", setting.key}, {"value", setting.value}, {"line", setting.line}});
    }
    print_json(object);
}

/// The effective scene: valid TOML, so that it can be saved and changed.
void print_settings(const Scene& scene) {
    std::string section;
    for (const Setting& setting : scene.settings) {
        const bool new_step = setting.section == "[programme]" && setting.key == "do";
        if (setting.section != section || new_step) {
            section = setting.section;
            say("\n[{}]\n", section);
        }
        const std::string assignment = fmt::format("{} = {}", setting.key, setting.value);
        say("{:<44} # {}\n", assignment, setting.line > 0 ? fmt::format("line {}", setting.line) : "default");
    }
}

} // namespace

int plan(const PlanArguments& arguments) {
    const Scene scene = read_scene(arguments.scene);
    if (!scene.start.empty()) {
        start_from_file(scene); // a start that a run would refuse is refused here
    }
    if (arguments.common.json) {
        print_plan(scene);
        return done;
    }
    const std::vector<PlanEntry> entries = make_plan(scene);
    for (const bool used : {true, false}) {
        say("# {}\n", used ? "used:" : "left out:");
        for (const PlanEntry& entry : entries) {
            if (entry.used == used) {
                say("#   {:<7} {}: {}\n", entry.kind, entry.name, entry.reason);
            }
        }
        say("#\n");
    }
    if (!scene.programme.empty()) {
        say("# programme:\n");
        for (std::size_t s = 0; s < scene.programme.size(); ++s) {
            say("#   {}. {}\n", s + 1, describe(scene.programme[s]));
        }
        say("#\n");
    }
    say("# {} with every default:\n", scene.file);
    print_settings(scene);
    return done;
}

} // namespace isostat::cli
