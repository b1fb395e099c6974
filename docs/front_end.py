"""A front end in 80 lines: model in, regions, job with progress, cancel, program out, errors as they are.

usage: front_end.py [PORT]    Open the address that it prints. It serves this machine only.
"""
import json
import secrets
import sys
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from urllib.parse import parse_qsl, urlsplit

import patchmill as pm

KEY = secrets.token_urlsafe()  # part of every address: pages of other sites cannot guess it
PAGE = """<!doctype html><meta charset=utf-8><title>Mill</title>
<input type=file id=model> scallop <input id=scallop type=number value=0.05 step=any> mm
<button id=regions>Regions</button> <button id=mill>Mill</button> <button id=cancel>Cancel</button>
<progress id=bar value=0></progress> <a id=program hidden download=part.ngc>Program</a>
<pre id=text></pre><iframe id=view sandbox=allow-scripts style="width: 100%; height: 70vh"></iframe>
<script>
const by = (id) => document.getElementById(id);
const show = (line) => {
  const { text, share, page, program } = JSON.parse(line);
  [by("text").textContent, by("bar").value, by("program").hidden] = [text, share, !program];
  if (page) by("view").srcdoc = page;
  if (program) by("program").href = URL.createObjectURL(new Blob([program]));
};
for (const call of ["regions", "mill", "cancel"]) by(call).onclick = async () => {
  const file = by("model").files[0];
  const query = new URLSearchParams({ name: file?.name ?? "", scallop: by("scallop").value });
  const answer = await fetch(`${call}?${query}`, { method: "POST", body: call === "cancel" ? "" : file ?? "" });
  let rest = "";
  for await (const part of answer.body.pipeThrough(new TextDecoderStream())) {
    const lines = (rest + part).split("\\n");
    rest = lines.pop();
    lines.forEach(show);
  }
};
</script>"""


class FrontEnd(BaseHTTPRequestHandler):
    client, cancel = pm.Client(), pm.Canceller()

    def do_GET(self):
        self.begin(self.path == f"/{KEY}/")
        self.wfile.write(PAGE.encode() if self.path == f"/{KEY}/" else b"")

    def do_POST(self):
        url, body = urlsplit(self.path), self.rfile.read(int(self.headers["Content-Length"]))
        query, calls = dict(parse_qsl(url.query)), {"regions": self.regions, "mill": self.mill, "cancel": FrontEnd.cancel_job}
        call = calls.get(url.path.removeprefix(f"/{KEY}/"))
        self.begin(call is not None)
        try:
            call and call(pm.Model.from_bytes(body, query["name"].split(".")[-1], name=query["name"]), pm.Operation(
                tool=pm.ball(6), scallop_mm=float(query["scallop"]), tolerance_mm=0.01))
        except (pm.PatchmillError, KeyError, ValueError) as error:
            self.say(text=f"{type(error).__name__}: {error}", share=0)

    def begin(self, is_found):
        self.send_response(200 if is_found else 404)
        self.end_headers()

    def say(self, **answer):
        self.wfile.write(json.dumps(answer).encode() + b"\n")

    def regions(self, model, operation):
        split = self.client.regions(model, operation)
        self.say(text=str(split), share=1, page=split.page())

    def mill(self, model, operation):
        FrontEnd.cancel = pm.Canceller()
        result = self.client.mill(model, operation, cancel=FrontEnd.cancel, progress=lambda p: self.say(text=p.stage, share=p.fraction))
        self.say(text=str(result), share=1, page=result.page(), program=result.program if result.has_program else "")

    @staticmethod
    def cancel_job(model, operation):
        FrontEnd.cancel()


if __name__ == "__main__":
    server = ThreadingHTTPServer(("127.0.0.1", int(sys.argv[1]) if len(sys.argv) > 1 else 8000), FrontEnd)
    print(f"http://127.0.0.1:{server.server_port}/{KEY}/", flush=True)
    server.serve_forever()
