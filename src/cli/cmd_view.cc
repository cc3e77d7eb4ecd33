// SPDX-License-Identifier: Apache-2.0
// cli/cmd_view.cc: nacre view [SCENE]
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "base/version.h"
#include "cli/commands.h"
#include "cli/help_text.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "cli/render_options.h"
#include "view/page.h"
#include "view/server.h"
#include "view/token.h"
#include "view/worker.h"

namespace nacre {
namespace {

struct ViewArguments {
  std::string scene;
  bool no_open = false;
  ServerOptions server;
  RenderOptions options;
};

// The user's browser, if there is a display to show it on. Whether it comes is its own affair: the
// address has been printed.
void OpenBrowser(const std::string& url) {
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return;
  std::string program = "/usr/bin/xdg-open", argument = url;
  char* const arguments[] = {program.data(), argument.data(), nullptr};
  pid_t child = 0;
  if (posix_spawn(&child, program.c_str(), nullptr, nullptr, arguments, environ) != 0) {
    PrintError("note: there is no {} to open a browser with; open the address yourself\n", program);
    return;
  }
  std::thread([child] { waitpid(child, nullptr, 0); }).detach();
}

bool IsLoopback(const std::string& address) {
  return address == "::1" || address.starts_with("127.");
}

LoadOptions MakeViewLoadOptions(const RenderOptions& options) {
  // The samples are of the resting picture, and the worker's own.
  RenderOptions of_scene = options;
  of_scene.spp.reset();
  LoadOptions load = MakeLoadOptions(of_scene);
  load.on_progress = [](double) { ThrowIfStopped(); };
  return load;
}

void RunView(const ViewArguments& arguments, int* exit_code) {
  const RenderOptions& options = arguments.options;
  ApplyTarget(options.target);
  const LoadOptions load = MakeViewLoadOptions(options);
  const auto open = [&]() -> std::unique_ptr<ViewDocument> {
    if (arguments.scene.empty()) return std::make_unique<ViewDocument>(load);
    return std::make_unique<ViewDocument>(arguments.scene, load);
  };
  WorkerOptions work;
  work.samples = options.spp.value_or(0);
  work.max_error = options.max_error;
  work.threads = options.threads;
  work.display.tone = ParseToneOperator(options.tonemap);
  work.display.exposure_ev = options.exposure;
  work.file = arguments.scene;
  if (!options.size.empty()) work.given = {"--size", options.size};
  for (const std::string& set : options.sets) {
    work.given.emplace_back("--set");
    work.given.push_back(set);
  }
  Worker worker(open, work);

  ServerOptions server_options = arguments.server;
  // A port that was asked for is asked for again.
  server_options.token = server_options.port != 0 ? KeptToken(server_options.port) : MakeToken();
  const std::string title =
      arguments.scene.empty() ? "nacre view" : fmt::format("{} - nacre view", arguments.scene);
  Server server(
      server_options,
      MakeViewPage(title, fmt::format("nacre {} ({})", kVersion, kCommit), options.tonemap,
                   options.exposure),
      {[&](ClientId id) { worker.Opened(id); }, [&](ClientId id) { worker.Closed(id); },
       [&](ClientId id, std::string_view text) { worker.Receive(id, text); },
       [&](double ms, size_t bytes) { worker.Ready(ms, bytes); }, [] { ThrowIfStopped(); }});
  if (!IsLoopback(server_options.address)) {
    PrintError(
        "warning: {} can be reached from other machines, and what is sent there is not "
        "encrypted: put a proxy with TLS ahead of it, and name it by --origin https://HOST\n",
        server_options.address);
  }
  PrintOut("{}\n", server.url());
  FinishOutput();
  if (!options.quiet) PrintError("nacre view: open the address above; Ctrl-C ends it\n");
  if (!arguments.no_open) OpenBrowser(server.url());

  worker.Start({[&](SharedBytes frame) { server.Show(std::move(frame)); },
                [&](ClientId id, std::string text) { server.Say(id, std::move(text)); },
                [&](ClientId id, SharedBytes bytes) { server.Send(id, std::move(bytes)); }});
  try {
    server.Run();
  } catch (const Error& error) {
    worker.Stop();
    if (error.code() != ExitCode::kInterrupted && error.code() != ExitCode::kTerminated) throw;
    *exit_code = static_cast<int>(error.code());  // a signal is how it ends
  } catch (...) {
    worker.Stop();
    throw;
  }
}

}  // namespace

void AddViewCommand(CLI::App* app, int* exit_code) {
  CLI::App* command = app->add_subcommand(
      "view", "Show a scene in the browser, with a slider for everything that can be changed");
  const auto arguments = std::make_shared<ViewArguments>();
  command->add_option("SCENE", arguments->scene,
                      "Scene file (.json) or model (.gltf, .glb, .obj, .ply); without one, Phong "
                      "and physically based spheres beside a grid");
  command
      ->add_option("--port", arguments->server.port,
                   "Port to listen on; 0: one that is free. With a port the address stays the same "
                   "from one start to the next, and open pages find the server again")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command->add_flag("--no-open", arguments->no_open, "Open no browser, only print the address");
  RenderOptions* const o = &arguments->options;
  AddDisplayOptions(command, &o->tonemap, &o->exposure);
  command->add_option("--size", o->size, "Width and height in pixels")->type_name("WxH");
  command
      ->add_option("--spp", o->spp,
                   "Samples per pixel once nothing moves; the scene's if not given")
      ->check(CLI::Range(1, 65536));
  command
      ->add_option("--max-error", o->max_error,
                   "Once nothing moves, sample until each pixel's relative error is below this")
      ->check(InRange(1e-6, 1))
      ->type_name("E");
  command->add_option("--set", o->sets, "Change a value of the scene, as render does; repeatable")
      ->type_name("/POINTER=JSON")
      ->allow_extra_args(false);
  command
      ->add_option(
          "--listen", arguments->server.address,
          "Address to listen on. Any but this machine's own (127.0.0.1, ::1) needs a proxy "
          "with TLS ahead of it")
      ->capture_default_str();
  command
      ->add_option("--origin", arguments->server.origin,
                   "How browsers call the proxy ahead, e.g. https://nacre.example.org")
      ->type_name("URL");
  command->add_flag("--quiet", o->quiet, "Print nothing but the address and errors");
  AddMachineOptions(command, o);
  MoveBehindHelpAll(command, {"--listen", "--origin", "--quiet", "--max-error"});
  command->footer(
      "Examples:\n"
      "  nacre view\n"
      "  nacre view scenes/material_grid.json --spp 64\n"
      "  nacre view scene.json --port 8080 --no-open");
  command->callback([arguments, exit_code] { RunView(*arguments, exit_code); });
}

}  // namespace nacre
