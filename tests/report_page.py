#!/usr/bin/python3
"""Pages of vox diff and vox check in Chromium: nothing is loaded, no errors, no page wider than a phone,
the view turns, and the pictures are there without WebGL. Screenshots stay in FOLDER.

Usage: report_page.py VOX SCENES FOLDER
"""

import os
import shutil
import subprocess
import sys
import tempfile
import urllib.parse

try:
    from selenium import webdriver
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.chrome.service import Service
except ImportError:
    print("skipped: python3-selenium is not installed")
    sys.exit(77)

vox, scenes, pictures = map(os.path.abspath, sys.argv[1:])
for program in ("chromium", "chromedriver"):
    if not shutil.which(program):
        print(f"skipped: {program} is not installed")
        sys.exit(77)
os.makedirs(pictures, exist_ok=True)


def run(*words, code):
    done = subprocess.run([vox, *words], capture_output=True, text=True)
    assert done.returncode == code, f"vox {words}: {done.returncode}: {done.stderr}"


def browser(webgl, size, dark=False):
    options = webdriver.ChromeOptions()
    for flag in ("headless=new", "no-sandbox", "hide-scrollbars", "disable-dev-shm-usage",
                 f"window-size={size[0]},{size[1]}"):
        options.add_argument("--" + flag)
    if webgl:
        for flag in ("use-gl=angle", "use-angle=swiftshader", "enable-unsafe-swiftshader"):
            options.add_argument("--" + flag)
    else:
        options.add_argument("--disable-3d-apis")
    if dark:
        options.add_argument("--force-dark-mode")
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = webdriver.Chrome(service=Service("chromedriver"), options=options)
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                           {"width": size[0], "height": size[1], "deviceScaleFactor": 1, "mobile": False})
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia",
                           {"features": [{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]})
    return driver


def frames(driver):
    """Waits until what was asked for is drawn."""
    driver.execute_async_script(
        "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(done));")


def pixels(driver):
    """Colours of the view: one text for each pixel of a small copy of it."""
    frames(driver)
    return driver.execute_script("""
        const view = document.querySelector(".viewer canvas");
        const copy = document.createElement("canvas");
        [copy.width, copy.height] = [80, 60];
        const context = copy.getContext("2d");
        context.drawImage(view, 0, 0, 80, 60);
        const data = context.getImageData(0, 0, 80, 60).data;
        return Array.from({length: 4800}, (_, i) => Array.from(data.slice(4 * i, 4 * i + 4)).join());
    """)


def changed(a, b):
    return sum(x != y for x, y in zip(a, b))


def open_page(driver, page):
    driver.get("file://" + urllib.parse.quote(page))
    frames(driver)
    width, seen = driver.execute_script(
        "return [document.documentElement.scrollWidth, document.documentElement.clientWidth]")
    assert width <= seen, f"{page} is {width} pixels wide, the window {seen}"
    loaded = driver.execute_script(
        "return Array.from(document.images).every(i => i.complete && i.naturalWidth > 0)")
    assert loaded, "a picture is broken"
    for picture in driver.find_elements(By.TAG_NAME, "img"):
        assert picture.get_attribute("alt"), "a picture without a text"


def require_silence(driver):
    messages = [m for m in driver.get_log("browser") if m["level"] in ("SEVERE", "WARNING")]
    assert not messages, messages
    for entry in driver.get_log("performance"):
        if '"Network.requestWillBeSent"' in entry["message"]:
            assert '"url":"file:' in entry["message"] or '"url":"data:' in entry["message"], entry


def screenshot(driver, name):
    height = driver.execute_script("return document.documentElement.scrollHeight")
    width = driver.execute_script("return document.documentElement.clientWidth")
    data = driver.execute_cdp_cmd("Page.captureScreenshot", {
        "captureBeyondViewport": True, "clip": {"x": 0, "y": 0, "width": width, "height": height, "scale": 1}})
    import base64
    with open(os.path.join(pictures, name), "wb") as file:
        file.write(base64.b64decode(data["data"]))


def turn(driver):
    """The view turns by pointer, keys and buttons, and comes back."""
    canvas = driver.find_element(By.CSS_SELECTOR, ".viewer canvas")
    driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", canvas)
    first = pixels(driver)
    empty = max(set(first), key=first.count)
    drawn = [i for i, pixel in enumerate(first) if pixel != empty]
    assert 100 < len(drawn) < 4000, f"{len(drawn)} of 4800 pixels are drawn"
    ActionChains(driver).click_and_hold(canvas).move_by_offset(80, 40).release().perform()
    dragged = pixels(driver)
    assert changed(first, dragged) > 50, "dragging does not turn the voxels"
    driver.execute_script("arguments[0].focus()", canvas)
    ActionChains(driver).send_keys(Keys.ARROW_LEFT).perform()
    assert changed(dragged, pixels(driver)) > 50, "keys do not turn the voxels"
    driver.find_element(By.CSS_SELECTOR, "button[name=start]").click()
    assert changed(first, pixels(driver)) == 0, "the first view does not come back"
    driver.find_element(By.CSS_SELECTOR, "button[name=nearer]").click()
    nearer = pixels(driver)
    assert sum(pixel != empty for pixel in nearer) > 1.2 * len(drawn), "nearer is not larger"
    driver.find_element(By.CSS_SELECTOR, "button[name=start]").click()
    return first


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    jack = os.path.join(scenes, "toy_jack.obj")
    strange = "b<script>document.title='wrong'</script>&.vdb".replace("/", "")
    options = ["--dim", "100", "--grids", "density,surface"]
    run("convert", jack, "-o", "a.vdb", *options, code=0)
    run("convert", jack, "-o", strange, *options, "--until", "levels=1", code=0)
    run("diff", "a.vdb", strange, "--report", "diff.html", code=1)
    run("diff", "a.vdb", "a.vdb", "--report", "same.html", code=0)
    run("check", "a.vdb", "--report", "check.html", code=0)
    words = ["check", "a.vdb", "--mesh", jack, "--boundary", "free", "--weld", "0.001"]
    run(*words, "--report", "mesh.html", code=0)
    with open("mesh.html", encoding="utf-8") as file:
        assert "<pre>vox " + " ".join(words) + "</pre>" in file.read(), "the command is not whole"
    for page in ("diff.html", "same.html", "check.html"):
        assert os.path.getsize(page) < 2000000, page
        if shutil.which("tidy"):
            found = subprocess.run(["tidy", "-q", "-e", page], capture_output=True, text=True)
            assert found.returncode == 0, f"{page}: {found.stderr[:1000]}"

    for size, dark in (((1280, 900), False), ((390, 844), True)):
        driver = browser(True, size, dark)
        try:
            open_page(driver, os.path.join(folder, "diff.html"))
            assert driver.title.startswith("Different: a.vdb and b<script>"), driver.title
            assert "b<script>" in driver.find_element(By.TAG_NAME, "body").text
            view = turn(driver)
            common = driver.find_element(By.CSS_SELECTOR, "input[name=onlyA]")
            driver.execute_script("arguments[0].click()", common)
            assert changed(view, pixels(driver)) > 20, "voxels cannot be switched off"
            driver.execute_script("arguments[0].click()", common)
            screenshot(driver, f"diff_{size[0]}.png")
            open_page(driver, os.path.join(folder, "check.html"))
            turn(driver)
            screenshot(driver, f"check_{size[0]}.png")
            open_page(driver, os.path.join(folder, "same.html"))
            assert not driver.find_elements(By.TAG_NAME, "img")
            require_silence(driver)
        finally:
            driver.quit()

    driver = browser(False, (1280, 900))
    try:
        open_page(driver, os.path.join(folder, "diff.html"))
        assert driver.find_elements(By.TAG_NAME, "img")
        assert not driver.find_element(By.CSS_SELECTOR, ".viewer canvas").is_displayed()
        assert driver.find_element(By.CSS_SELECTOR, ".viewer .fallback").is_displayed()
        require_silence(driver)
        screenshot(driver, "without_webgl.png")
    finally:
        driver.quit()
print("the pages are shown, and the voxels turn")
