import re, time, json
import httpx, pytest
from tests.server.moving_scans.moving import moving_person
from tests.web.test_moving_scans import add, wait_for_frame
from tests.server.calibrations.films import make_form, render_films
from tests.web.test_pages import track, NOTHING_LOADS
__all__=["moving_person","track"]
pytestmark=[pytest.mark.browser, pytest.mark.timeout(580)]
SIZES=[(1280,720),(1920,1080)]
def shoot(open_page, address, name, ready, screenshots, settle=1500):
    for scheme in ("dark","light"):
        page=open_page(1280,720,scheme)
        page.goto(address); ready(page)
        for w,h in SIZES:
            page.set_viewport_size({"width":w,"height":h}); page.wait_for_timeout(settle)
            screenshots.take(page, f"{name}-{w}-{scheme}")
idle=lambda p: (p.locator("main h1").first.wait_for(state="attached"), p.wait_for_function(NOTHING_LOADS))
def test_eye_track(open_page, studio, screenshots, track):
    shoot(open_page,f"/tracks/{track['id']}?frame=3","track",idle,screenshots,3000)
    shoot(open_page,"/tracks","tracks",idle,screenshots,500)
    shoot(open_page,f"/recordings/{track['sequence_id']}","recording",idle,screenshots,500)
def test_eye_calibrations(open_page, studio, screenshots):
    from playwright.sync_api import expect
    films=render_films()
    ids=[]
    for n in ("Rig of the lab, eight corners","Second rig"):
        r=studio.send("POST","/calibrations",**make_form(films,n)); assert r.status_code==201,r.text
        ids.append(r.json()["id"])
    page=open_page()
    page.goto(f"/calibrations/{ids[0]}")
    page.get_by_role("button", name="Calibrate", exact=True).click()
    expect(page.get_by_role("region", name="Cameras").get_by_role("row", name=re.compile("cam1"))).to_be_visible(timeout=180_000)
    shoot(open_page,"/calibrations","calibrations",idle,screenshots,500)
    shoot(open_page,f"/calibrations/{ids[0]}","calibration",idle,screenshots,1500)
def test_eye_moving(open_page, moving_person, studio, screenshots, tmp_path):
    page=open_page()
    add(page, moving_person, tmp_path/"w", "Ada waves"); wait_for_frame(page,0)
    shoot(open_page,"/scans/moving","movinglist",idle,screenshots,500)
    shoot(open_page,page.url,"moving0",idle,screenshots,2500)
def test_eye_registered(open_page, moving_person, studio, screenshots, tmp_path):
    from playwright.sync_api import expect
    page=open_page()
    add(page, moving_person, tmp_path/"w", "Ada waves again"); wait_for_frame(page,0)
    page.get_by_role("button", name="Register …").click()
    page.get_by_label("First frame").fill("2")
    page.get_by_role("dialog").get_by_role("button", name="Register", exact=True).click()
    page.keyboard.press("End")
    expect(page.get_by_label("The frame", exact=True)).to_contain_text("Scan to body, mean", timeout=300_000)
    expect(page.get_by_role("region", name="The job")).to_have_count(0, timeout=100_000)
    page.get_by_label("From frame").fill("2")
    page.get_by_role("button", name="Accept", exact=True).click()
    page.wait_for_timeout(800)
    shoot(open_page,page.url,"moving1",idle,screenshots,3000)
