// SPDX-License-Identifier: Apache-2.0
#include "view/page.h"

#include <utility>

#include "base/printable.h"
#include "report/page.h"
#include "report/page_parts.h"
#include "scene_io/json_text.h"
#include "scene_io/schema.h"
#include "view/page_parts.h"

namespace nacre {

ServedPage MakeViewPage(const std::string& title, const std::string& generator,
                        const DisplaySettings& display) {
  // The schema contains the parameters of all models, with ranges, defaults and descriptions.
  const std::string data = ScriptJson({{"tone", ToneOperatorName(display.tone)},
                                       {"exposure", display.exposure_ev},
                                       {"generator", generator},
                                       {"schema", Json::parse(SceneSchema())}});
  const std::string safe_title = EscapeHtml(Printable(title));
  ServedPage page;
  page.html = FillPage(
      ViewTemplate(),
      {{"title", safe_title}, {"style", ViewStyle()}, {"script", ViewScript()}, {"data", data}});
  page.style_hashes = "'" + PolicySource(ViewStyleSha256()) + "'";
  page.script_hashes = "'" + PolicySource(ViewScriptSha256()) + "'";
  return page;
}

ServedPage MakeImagesPage(std::string report) {
  // Removes the page's own content security policy, which is for a file. The server sends an
  // equivalent one that also allows its socket.
  const size_t policy = report.find("<meta http-equiv");
  report.erase(policy, report.find('\n', policy) + 1 - policy);
  std::string script = "<script>";
  script += ViewImagesScript();
  script += "</script>\n";
  report.insert(report.rfind("</body>"), script);
  ServedPage page;
  page.html = std::move(report);
  page.style_hashes = "'" + PolicySource(PageStyleSha256()) + "'";
  page.script_hashes =
      "'" + PolicySource(PageScriptSha256()) + "' '" + PolicySource(ViewImagesScriptSha256()) + "'";
  return page;
}

}  // namespace nacre
