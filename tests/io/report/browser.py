"""Chromium without a screen, driven through its debugging protocol over two pipes; and PNG pictures as pixels."""

import base64
import json
import os
import struct
import subprocess
import tempfile
import zlib

OPTIONS = ["--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
           "--remote-debugging-pipe", "--no-first-run", "--disable-dev-shm-usage", "--disable-background-networking", "--disable-sync",
           "--host-resolver-rules=MAP * ~NOTFOUND", "--hide-scrollbars", "--force-device-scale-factor=1"]


class Browser:
    def __init__(self, program, width, height):
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        to_browser, self.send_end = os.pipe()
        self.receive_end, from_browser = os.pipe()
        # The browser reads commands from descriptor 3 and answers on descriptor 4.
        keep = [os.dup2(to_browser, 103), os.dup2(from_browser, 104)]
        command = f"exec \"$@\" 3<&{keep[0]} 4>&{keep[1]}"
        arguments = [program, *OPTIONS, f"--user-data-dir={self.profile.name}", f"--window-size={width},{height}", "about:blank"]
        self.process = subprocess.Popen(["bash", "-c", command, "browser", *arguments], pass_fds=keep,
                                        stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        for descriptor in [to_browser, from_browser, *keep]:
            os.close(descriptor)
        self.received, self.number, self.attached, self.events = b"", 0, None, []
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        self.attached = self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ["Page", "Runtime", "Network"]:
            self.ask(f"{domain}.enable")
        self.ask("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
        self.ask("Network.emulateNetworkConditions", offline=True, latency=0, downloadThroughput=0, uploadThroughput=0)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        os.close(self.send_end)
        self.process.terminate()
        self.process.wait(30)
        os.close(self.receive_end)
        self.profile.cleanup()

    def message(self):
        while b"\0" not in self.received:
            piece = os.read(self.receive_end, 1 << 20)
            if not piece:
                raise RuntimeError("the browser ended")
            self.received += piece
        text, self.received = self.received.split(b"\0", 1)
        return json.loads(text)

    def ask(self, method, **parameters):
        self.number += 1
        command = {"id": self.number, "method": method, "params": parameters}
        if self.attached:
            command["sessionId"] = self.attached
        os.write(self.send_end, json.dumps(command).encode() + b"\0")
        while True:
            message = self.message()
            if message.get("id") == self.number:
                if "error" in message:
                    raise RuntimeError(f"{method}: {message['error']['message']}")
                return message["result"]
            self.events.append(message)

    def open(self, address):
        self.ask("Page.navigate", url=address)
        while not any(event.get("method") == "Page.loadEventFired" for event in self.events):
            self.events.append(self.message())

    def run(self, script):
        """The value of an expression of the page, which may be a promise."""
        answer = self.ask("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(f"{script}: {answer['exceptionDetails']}")
        return answer["result"].get("value")

    def faults(self):
        """What the page has thrown, and addresses other than its own that it has asked for."""
        thrown = [event["params"]["exceptionDetails"]["exception"].get("description", "") for event in self.events
                  if event.get("method") == "Runtime.exceptionThrown"]
        asked = [event["params"]["request"]["url"] for event in self.events
                 if event.get("method") == "Network.requestWillBeSent"]
        return thrown, [address for address in asked if not address.startswith("file:")]

    def png(self, **options):
        """The page as a picture, after what it has still to draw."""
        self.run("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
        return base64.b64decode(self.ask("Page.captureScreenshot", format="png", **options)["data"])

    def picture(self, box):
        """Pixels within a box (x, y, width, height) of the page, row by row: red, green and blue."""
        clip = dict(zip(("x", "y", "width", "height"), (int(value) for value in box)), scale=1)
        _, _, rows, bytes_each = pixels(self.png(clip=clip))
        return [[tuple(row[i:i + 3]) for i in range(0, len(row), bytes_each)] for row in rows]


def pixels(png):
    """Width, height, rows of bytes and bytes a pixel of a PNG with 8 bits a colour, not interlaced."""
    place, packed = 8, b""
    while place < len(png):
        length, kind = struct.unpack(">I4s", png[place:place + 8])
        content = png[place + 8:place + 8 + length]
        if kind == b"IHDR":
            width, height, depth, colours = struct.unpack(">IIBB", content[:10])
        if kind == b"IDAT":
            packed += content
        place += 12 + length
    if depth != 8 or colours not in (2, 6):
        raise ValueError("not a picture with 8 bits a colour")
    each = 3 if colours == 2 else 4
    data, rows, before = zlib.decompress(packed), [], bytearray(width * each)
    for y in range(height):
        begin = y * (width * each + 1)
        row = unfiltered(data[begin], bytearray(data[begin + 1:begin + 1 + width * each]), before, each)
        rows.append(row)
        before = row
    return width, height, rows, each


def unfiltered(kind, row, above, each):
    """A row of a PNG from what is stored of it, which are differences from its neighbours."""
    for i in range(len(row)):
        left = row[i - each] if i >= each else 0
        if kind == 1:
            row[i] = (row[i] + left) & 255
        elif kind == 2:
            row[i] = (row[i] + above[i]) & 255
        elif kind == 3:
            row[i] = (row[i] + (left + above[i]) // 2) & 255
        elif kind == 4:
            corner = above[i - each] if i >= each else 0
            guess = left + above[i] - corner
            distances = abs(guess - left), abs(guess - above[i]), abs(guess - corner)
            row[i] = (row[i] + (left, above[i], corner)[distances.index(min(distances))]) & 255
    return row
