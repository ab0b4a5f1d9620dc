"""Certificates for tests, made by the openssl tool: each is its own root."""

import ssl
import subprocess


class Certificate:
    """PEM files of a certificate for 127.0.0.1 and localhost, and of its key."""

    def __init__(self, folder, name="server", passphrase=None):
        folder.mkdir(parents=True, exist_ok=True)
        self.certificate = folder / f"{name}.pem"
        self.key = folder / f"{name}.key"
        kind = ["-passout", f"pass:{passphrase}"] if passphrase else ["-nodes"]
        subprocess.run(
            ["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt",
             "ec_paramgen_curve:prime256v1", *kind, "-keyout", self.key, "-out", self.certificate,
             "-days", "2", "-subj", f"/CN={name}", "-addext",
             "subjectAltName=IP:127.0.0.1,DNS:localhost"],
            check=True, capture_output=True)

    @property
    def options(self):
        """Those of a server that has it."""
        return ["--tls-certificate", self.certificate, "--tls-key", self.key]

    @property
    def digest(self):
        return ssl.PEM_cert_to_DER_cert(self.certificate.read_text())

    def client_context(self):
        """A client's that trusts this one alone."""
        return ssl.create_default_context(cafile=self.certificate)

    def server_context(self):
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        context.load_cert_chain(self.certificate, self.key)
        return context
