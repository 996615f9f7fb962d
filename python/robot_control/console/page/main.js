// The page: each module takes what it needs of the messages.
import { connect } from "/link.js";
import "/panels.js";
import "/drive.js";
import "/work.js";
import "/scene.js";
import "/plots.js";

connect();
