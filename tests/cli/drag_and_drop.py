# SPDX-License-Identifier: Apache-2.0
"""Files dropped on a window of X11 as a file manager drops them: the source's side of XDND, version 5, by Xlib itself.

Protocol: https://freedesktop.org/wiki/Specifications/XDND. Steps: 1 own the selection, 2 enter and move over the window, which
says whether it takes what is held, 3 let go, 4 hand over the list of URIs when it asks, 5 wait until it has it."""
import ctypes
import ctypes.util
import os
import time
import urllib.parse

VERSION = 5
CLIENT_MESSAGE, SELECTION_REQUEST, SELECTION_NOTIFY, PROPERTY_REPLACE = 33, 30, 31, 0
URI_LIST = "text/uri-list"
XID = ctypes.c_ulong


class ClientMessage(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int), ("display", ctypes.c_void_p),
                ("window", XID), ("message_type", XID), ("format", ctypes.c_int), ("data", ctypes.c_long * 5)]


class SelectionRequest(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int), ("display", ctypes.c_void_p),
                ("owner", XID), ("requestor", XID), ("selection", XID), ("target", XID), ("property", XID), ("time", ctypes.c_ulong)]


class SelectionNotify(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int), ("display", ctypes.c_void_p),
                ("requestor", XID), ("selection", XID), ("target", XID), ("property", XID), ("time", ctypes.c_ulong)]


class Event(ctypes.Union):
    _fields_ = [("type", ctypes.c_int), ("client", ClientMessage), ("request", SelectionRequest), ("notify", SelectionNotify),
                ("pad", ctypes.c_long * 24)]


def open_xlib():
    """None where there is none."""
    name = ctypes.util.find_library("X11")
    if name is None:
        return None
    xlib = ctypes.CDLL(name)
    xlib.XOpenDisplay.restype = ctypes.c_void_p
    xlib.XInternAtom.restype = XID
    xlib.XDefaultRootWindow.restype = XID
    xlib.XCreateSimpleWindow.restype = XID
    return xlib


class Source:
    """What holds the files. `with Source(display) as source: source.drop(...)`"""

    def __init__(self, display):
        self.xlib = open_xlib()
        self.display = ctypes.c_void_p(self.xlib.XOpenDisplay(display.encode()))
        if not self.display:
            raise AssertionError(f"no display {display}")
        root = XID(self.xlib.XDefaultRootWindow(self.display))
        self.window = self.xlib.XCreateSimpleWindow(self.display, root, 0, 0, 1, 1, 0, XID(0), XID(0))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.xlib.XCloseDisplay(self.display)

    def atom(self, name):
        return self.xlib.XInternAtom(self.display, name.encode(), 0)

    def send(self, target, message, *data):
        event = Event()
        event.client = ClientMessage(type=CLIENT_MESSAGE, window=target, message_type=self.atom(message), format=32)
        event.client.data[0] = self.window
        for index, value in data:
            event.client.data[index] = value
        self.xlib.XSendEvent(self.display, XID(target), 0, ctypes.c_long(0), ctypes.byref(event))
        self.xlib.XFlush(self.display)

    def next_event(self, seconds):
        end = time.monotonic() + seconds
        while self.xlib.XPending(self.display) == 0:
            if time.monotonic() > end:
                raise AssertionError(f"the window did not answer within {seconds} s")
            time.sleep(0.005)
        event = Event()
        self.xlib.XNextEvent(self.display, ctypes.byref(event))
        return event

    def wait_for(self, message, uris, seconds):
        """The window's answer; the list is handed over meanwhile if it asks."""
        while True:
            event = self.next_event(seconds)
            if event.type == SELECTION_REQUEST:
                self.hand_over(event.request, uris)
            if event.type == CLIENT_MESSAGE and event.client.message_type == self.atom(message):
                return event.client.data

    def hand_over(self, request, uris):
        self.xlib.XChangeProperty(self.display, XID(request.requestor), XID(request.property), XID(request.target), 8,
                                  PROPERTY_REPLACE, uris, len(uris))
        answer = Event()
        answer.notify = SelectionNotify(type=SELECTION_NOTIFY, requestor=request.requestor, selection=request.selection,
                                        target=request.target, property=request.property, time=request.time)
        self.xlib.XSendEvent(self.display, XID(request.requestor), 0, ctypes.c_long(0), ctypes.byref(answer))
        self.xlib.XFlush(self.display)

    def drop(self, window, files, place=(100, 100), seconds=30):
        """`files`: paths; `place`: of the pointer, from the corner of the screen."""
        uris = "".join(f"file://{urllib.parse.quote(os.path.abspath(file))}\r\n" for file in files).encode()
        self.xlib.XSetSelectionOwner(self.display, XID(self.atom("XdndSelection")), XID(self.window), ctypes.c_ulong(0))  # 1
        self.send(window, "XdndEnter", (1, VERSION << 24), (2, self.atom(URI_LIST)))  # 2
        for step in range(5):
            x, y = place[0] + 4 * step, place[1] + 2 * step
            self.send(window, "XdndPosition", (2, x << 16 | y), (4, self.atom("XdndActionCopy")))
            if not self.wait_for("XdndStatus", uris, seconds)[1] & 1:
                raise AssertionError("the window takes no files")
        self.send(window, "XdndDrop")  # 3
        # GLFW 3.3 sends how many bytes it has got where the lowest bit should be.
        if not self.wait_for("XdndFinished", uris, seconds)[1]:  # 4, 5
            raise AssertionError("the window did not take the files")
