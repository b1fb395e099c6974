"""The files of deploy: they parse, agree with the server and with each other, and are safe by default."""
import re
import shutil
import subprocess
import unittest

import yaml
from support import BIN, PATCHMILLD, ROOT, Folder, refused

DEPLOY = ROOT / "deploy"
# Where the flag is explained; nothing else that ships may use it.
MAY_NAME_INSECURE = {"server/serve_flags.h", "server/server.cc", "server/operate/serve_words.h", "CHANGELOG.md", "docs/service.md",
                     "docs/operations.md", "scripts/container_test.sh"}


def options():
    text = subprocess.run([PATCHMILLD, "--help"], capture_output=True, text=True, check=True).stdout
    return set(re.findall(r"^  (--[\w-]+)", text, re.MULTILINE))


def kubernetes():
    return {f"{d['kind']}": d for d in yaml.safe_load_all((DEPLOY / "kubernetes/patchmill.yaml").read_text())}


class Files(unittest.TestCase):
    def names_options(self, variables):
        for variable in variables:
            self.assertIn("--" + variable.removeprefix("PATCHMILLD_").lower().replace("_", "-"), options(), variable)

    def test_nothing_that_ships_is_insecure(self):
        listing = ["git", "ls-files", "-co", "--exclude-standard"]
        shipped = subprocess.run(listing, cwd=ROOT, capture_output=True, text=True, check=True).stdout.split()
        found = set()
        for name in shipped:
            path = ROOT / name
            if name.startswith("tests/") or not path.is_file() or path.stat().st_size > 1 << 20:
                continue
            if re.search(rb"--insecure|PATCHMILLD_INSECURE|^\s*insecure\s*=\s*true", path.read_bytes(), re.MULTILINE):
                found.add(name)
        self.assertLessEqual(found, MAY_NAME_INSECURE)

    def test_the_configuration_and_the_tokens_are_read(self):
        with Folder() as folder:
            text = (DEPLOY / "patchmilld.conf").read_text()
            self.names_options(re.findall(r"^([\w-]+) =", text, re.MULTILINE))
            conf = folder.write("patchmilld.conf", text.replace("/etc/patchmill/tokens.conf", str(DEPLOY / "tokens.conf")))
            status, message = refused("--config", conf, program=[PATCHMILLD])
            self.assertEqual(status, 2)  # nobody has these certificates here
            self.assertIn("--cert /etc/patchmill/tls/tls.crt: cannot be read", message)
            from support import Server
            with Server("--tokens", str(DEPLOY / "tokens.conf")):
                pass

    def test_compose(self):
        service = yaml.safe_load((DEPLOY / "compose/compose.yaml").read_text())["services"]["patchmill"]
        self.names_options(service["environment"])
        self.assertTrue(service["read_only"])
        self.assertEqual(service["cap_drop"], ["ALL"])
        self.assertIn("PATCHMILLD_TOKENS", service["environment"])
        self.assertEqual(service["healthcheck"]["test"][:3], ["CMD", "patchmilld", "--check-health"])
        self.assertTrue((DEPLOY / "compose" / service["build"] / "Dockerfile").is_file())
        drain = int(service["environment"]["PATCHMILLD_DRAIN_SECONDS"])
        self.assertGreater(int(service["stop_grace_period"].removesuffix("s")), drain)

    def test_the_unit(self):
        unit = (DEPLOY / "systemd/patchmilld.service").read_text()
        drain = int(re.search(r"^drain-seconds = (\d+)", (DEPLOY / "patchmilld.conf").read_text(), re.MULTILINE)[1])
        self.assertGreater(int(re.search(r"^TimeoutStopSec=(\d+)", unit, re.MULTILINE)[1]), drain)
        self.assertIn("RestartPreventExitStatus=2", unit)
        if shutil.which("systemd-analyze") is None:
            self.skipTest("there is no systemd-analyze")
        with Folder() as folder:
            path = folder.write("patchmilld.service", unit.replace("/usr/local/bin/", f"{BIN}/"))
            said = subprocess.run(["systemd-analyze", "verify", "--man=no", path], capture_output=True, text=True)
            self.assertNotIn("patchmilld.service:", said.stderr)

    def test_nginx(self):
        conf = (DEPLOY / "nginx/patchmill.conf").read_text()
        bare = re.sub(r"#.*", "", conf)
        self.assertEqual(bare.count("{"), bare.count("}"))
        for line in bare.splitlines():
            self.assertRegex(line.strip(), r"^$|[;{}]$")
        self.assertIn("grpc_pass grpcs://patchmill;", conf)
        self.assertIn("grpc_ssl_verify on;", conf)
        self.assertIn("listen 443 ssl http2;", conf)
        self.assertNotIn("grpc_pass grpc://", conf)

    def test_kubernetes(self):
        found = kubernetes()
        self.assertEqual(set(found), {"Namespace", "Deployment", "Service", "PodDisruptionBudget", "HorizontalPodAutoscaler",
                                      "NetworkPolicy"})
        deployment = found["Deployment"]["spec"]
        pod = deployment["template"]["spec"]
        container = pod["containers"][0]
        env = {e["name"]: e["value"] for e in container["env"]}
        self.names_options(env)
        self.assertIs(pod["enableServiceLinks"], False)
        self.assertIs(pod["securityContext"]["runAsNonRoot"], True)
        self.assertIs(container["securityContext"]["readOnlyRootFilesystem"], True)
        self.assertEqual(container["securityContext"]["capabilities"], {"drop": ["ALL"]})
        self.assertGreater(pod["terminationGracePeriodSeconds"], int(env["PATCHMILLD_DRAIN_SECONDS"]))
        labels = deployment["template"]["metadata"]["labels"]
        self.assertEqual(deployment["selector"]["matchLabels"], labels)
        self.assertEqual(found["Service"]["spec"]["selector"], labels)
        self.assertEqual(found["PodDisruptionBudget"]["spec"]["selector"]["matchLabels"], labels)
        self.assertEqual(found["NetworkPolicy"]["spec"]["podSelector"]["matchLabels"], labels)
        self.assertLess(found["PodDisruptionBudget"]["spec"]["minAvailable"], deployment["replicas"])
        ports = {p["name"]: p["containerPort"] for p in container["ports"]}
        self.assertEqual(ports["grpc"], 50051)  # of the entry point of the image
        self.assertTrue(env["PATCHMILLD_METRICS_LISTEN"].endswith(f":{ports['metrics']}"))
        mounted = {m["name"] for m in container["volumeMounts"]}
        self.assertEqual(mounted, {v["name"] for v in pod["volumes"]})
        for probe, service in [("readinessProbe", "readiness"), ("livenessProbe", "liveness"), ("startupProbe", "readiness")]:
            self.assertEqual(container[probe]["exec"]["command"][:3], ["patchmilld", "--check-health", f"localhost:50051/{service}"])
        scaler = found["HorizontalPodAutoscaler"]["spec"]
        self.assertEqual(scaler["scaleTargetRef"]["name"], found["Deployment"]["metadata"]["name"])
        metric = scaler["metrics"][0]["pods"]["metric"]["name"]
        self.assertIn(f'"{metric}"', (ROOT / "server/operate/metrics.cc").read_text())
        self.assertTrue({"limits", "requests"} <= set(container["resources"]))


if __name__ == "__main__":
    unittest.main()
